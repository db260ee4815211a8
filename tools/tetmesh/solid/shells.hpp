#pragma once
// The closed components of a surface, and what lies on either side of each: material of a region, or nothing. Where
// sheets meet at edges of more than two triangles, the components are sheets; a sheet has the same region on all of one
// side.

#include <cstdint>
#include <string>
#include <vector>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::tetmesh::geometry {
class ColumnIndex;
}  // namespace hexpipe::tetmesh::geometry

namespace hexpipe::tetmesh::solid {

// The meaning of shells inside shells.
enum class ShellRule {
  oriented,  // by orientation: an outward shell encloses material (a region of its own), an inward one a hole
  regions,   // each shell encloses a region of its own, whatever its orientation
  holes      // in turn from outside: material, hole, material, whatever the orientation
};

// Whether triangles inside that have the same region on both sides stay.
enum class BaffleRule { drop, keep };

constexpr std::int32_t outside_region = 0;

struct Shell {
  std::size_t triangle_count = 0;
  std::int32_t first_triangle = 0;
  double volume = 0;          // enclosed volume, positive
  bool has_material = true;   // inside; false for a hole
  std::int32_t behind = 0;    // the region on the side that its triangles' normals point away from
  std::int32_t in_front = 0;  // the region on the side that they point to
};

// A soup that passed check_surface, with its regions. Triangles have material behind them: at a hole their normals
// point into the hole. The tags are those of the file if it tells triangles apart; otherwise they are the shell's
// number, from 1.
struct Surface : formats::SurfaceSoup {
  std::vector<std::int32_t> shell_of;  // of each triangle
  std::vector<Shell> shells;           // in the order of their first triangle
  std::int32_t region_count = 0;       // regions are numbered from 1 in the order of the shells that enclose them
  bool has_sheets = false;  // true: more than two triangles meet somewhere, and the components are not closed

  // The volume of each region. Entry 0 is zero.
  std::vector<double> region_volumes() const;
  // The volume of all regions.
  double volume() const;
};

// Whether p is inside an odd number of the shells between material and nothing. The index is that of the surface.
bool is_in_material(const Surface& surface, const geometry::ColumnIndex& columns, const Vec3& p);

// Finds the shells of a checked surface and their regions. Throws DataError with ShellRule::oriented if a shell points
// inward and no material is around it; the error names the shell's first triangle.
Surface find_shells(formats::SurfaceSoup soup, ShellRule rule);

// Makes the numbers of the shells the tags, from 1, if the file does not tell triangles apart.
void choose_tags(Surface& surface);

// The same shells with other triangles. These come in the order of the shells; `shell_of` has the shell of each.
Surface with_shells_of(const Surface& surface, formats::SurfaceSoup soup, std::vector<std::int32_t> shell_of);

}  // namespace hexpipe::tetmesh::solid
