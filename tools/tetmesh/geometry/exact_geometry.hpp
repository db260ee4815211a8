#pragma once
// Exact answers about points given in doubles, beside those of common/mesh/validity.hpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::geometry {

// The sign of the area of (a, b, c) projected along z: positive when they run counter-clockwise as seen from +z.
int orientation_along_z(const Vec3& a, const Vec3& b, const Vec3& c);

bool are_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

struct IntersectionReport {
  std::vector<std::array<std::int32_t, 2>> pairs;  // each pair ascending, and the pairs in ascending order
  bool complete = true;                            // false: there are more pairs than the limit
};

// Finds pairs of triangles that share more than the vertices that both name: they cross, touch, or overlap in a plane.
// No triangle may be degenerate.
IntersectionReport find_intersections(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                      std::size_t limit);

}  // namespace hexpipe::tetmesh::geometry
