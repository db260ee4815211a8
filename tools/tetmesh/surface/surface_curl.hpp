#pragma once
// Distances between the triangles of a surface that add up around its vertices, and fit its feature curves.

#include <span>
#include <vector>

#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// `kept` are the vertices of the surface that are points of the lattice: on features, from one to the next is one step.
void correct_curl(SurfaceLinks& links, std::span<const Vertex> kept);

// By half-edges of features: from the middle of the one before it to its own, on its left, in steps of a lattice whose
// rows are to go on beyond the feature and to reach the other features, wherever these have their points. 0 where the
// field does not tell.
std::vector<double> steps_along_features(const SurfaceLinks& links);

}  // namespace hexpipe::tetmesh::surface
