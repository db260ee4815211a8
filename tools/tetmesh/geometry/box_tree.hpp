#pragma once
// Trees of boxes around triangles.

#include "common/mesh/box_tree.hpp"

namespace hexpipe::tetmesh::geometry {

using hexpipe::Box;
using hexpipe::BoxTree;

// The values are 0, so that least() with a slope of 1 finds distances.
BoxTree tree_of_triangles(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace hexpipe::tetmesh::geometry
