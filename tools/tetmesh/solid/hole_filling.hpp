#pragma once
// Triangles for a hole in a surface.

#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::solid {

// The triangulation of least area of a closed polygon in space, oriented like it (G. Barequet, M. Sharir: Filling gaps
// in the boundary of a polyhedron, 1995). Time grows with the cube of the number of corners, three at least.
std::vector<Triangle> triangulate_polygon(std::span<const Vec3> points, std::span<const Vertex> corners);

}  // namespace hexpipe::tetmesh::solid
