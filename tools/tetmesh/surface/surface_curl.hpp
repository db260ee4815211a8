#pragma once
// Corrects the distances between the triangles of a surface so that they add up to zero around its vertices and fit its
// feature curves.

#include <span>
#include <vector>

#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// `kept` holds the vertices of the surface that are points of the lattice: on features, it is one step from each to the
// next.
void correct_curl(SurfaceLinks& links, std::span<const Vertex> kept);

// For each half-edge of a feature: the distance on its left from the middle of the half-edge before it to its own
// middle. It is in steps of a lattice whose rows continue beyond the feature and reach the other features, wherever
// these have their points. 0 where the field does not tell.
std::vector<double> steps_along_features(const SurfaceLinks& links);

}  // namespace hexpipe::tetmesh::surface
