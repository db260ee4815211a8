#pragma once
// How thick a tetrahedral mesh is behind the triangles of its surface.

#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"

namespace hexpipe::assemble::shape {

// For each tagged triangle, from its middle at right angles into the tets on either side, to where their region ends;
// at most the triangle's `reach`, which it also is for a triangle that is no facet of a tet.
std::vector<double> wall_thickness(const TetMesh& mesh, const TetAdjacency& adjacency, std::span<const double> reach);

}  // namespace hexpipe::assemble::shape
