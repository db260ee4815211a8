#pragma once
// The closed pieces of a surface, and what lies on either side of each: material of a region, or nothing. Where sheets
// meet at edges of more than two triangles, the pieces are sheets, each with the same on either side all over.

#include <cstdint>
#include <string>
#include <vector>

#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::tetmesh::geometry {
class ColumnIndex;
}  // namespace hexpipe::tetmesh::geometry

namespace hexpipe::tetmesh::solid {

// How shells inside shells are read.
enum class ShellRule {
  oriented,  // by orientation: outward encloses material (a region of its own), inward encloses a hole
  regions,   // each encloses a region of its own, whatever its orientation
  holes      // alternately, from outside: material, hole, material, whatever the orientation
};

constexpr std::int32_t outside_region = 0;

struct Shell {
  std::size_t triangle_count = 0;
  std::int32_t first_triangle = 0;
  double volume = 0;          // enclosed, positive
  bool has_material = true;   // inside; false: a hole
  std::int32_t behind = 0;    // region on the side that its triangles' normals point away from
  std::int32_t in_front = 0;  // region on the side that they point to
};

// A soup that passed check_surface, with its regions. Triangles have material behind them: at a hole they point into
// it. Tags are the file's where it tells triangles apart, else the shell's number from 1.
struct Surface : formats::SurfaceSoup {
  std::vector<std::int32_t> shell_of;  // of each triangle
  std::vector<Shell> shells;           // in the order of their first triangle
  std::int32_t region_count = 0;       // regions are numbered from 1 in the order of the shells that enclose them
  bool has_sheets = false;             // more than two triangles meet somewhere: the pieces are not closed

  // The volume of each region from its shells; entry 0 is zero.
  std::vector<double> region_volumes() const;
  // Of all regions.
  double volume() const;
};

// Inside an odd number of the shells between material and nothing. The index is that of the surface.
bool is_in_material(const Surface& surface, const geometry::ColumnIndex& columns, const Vec3& p);

// Finds the shells of a checked surface and their regions. Throws DataError naming the first triangle of a shell that
// encloses nothing where ShellRule::oriented wants material.
Surface find_shells(formats::SurfaceSoup soup, ShellRule rule);

// The numbers of the shells, from 1, where the file does not tell triangles apart.
void choose_tags(Surface& surface);

// The same shells of other triangles, which come in the order of the shells: `shell_of` of each its number.
Surface with_shells_of(const Surface& surface, formats::SurfaceSoup soup, std::vector<std::int32_t> shell_of);

}  // namespace hexpipe::tetmesh::solid
