#pragma once
// Where triangles cross each other, as tetmesh refuses them, without its CGAL.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tessellate {

// Pairs of triangles that share more than the corners that both name: they cross, touch, or overlap in a plane. This is
// decided exactly. Pairs with the same corners, and those beside triangles without area, are left out, because tetmesh
// mends these faults first. At most 10,000 pairs.
std::vector<std::array<std::int32_t, 2>> crossing_triangles(std::span<const Vec3> points,
                                                            std::span<const Triangle> triangles);

}  // namespace hexpipe::tessellate
