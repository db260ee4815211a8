#pragma once
// Triangles for a hole in a surface.

#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::solid {

// One edge of a hole's border. The edges come in the order in which the new triangles turn around the hole.
struct HoleEdge {
  Vertex start;
  Vertex across;  // the third corner of the triangle that is at the edge
};

// The triangulation, without new points, that bends least: the greatest angle between neighbouring triangles is least,
// those beside the hole included, and among such triangulations the area (P. Liepa: Filling holes in meshes, 2003).
// Empty where CGAL finds none. Time grows with the cube of the number of edges.
std::vector<Triangle> fill_hole(std::span<const Vec3> points, std::span<const HoleEdge> border);

}  // namespace hexpipe::tetmesh::solid
