#pragma once
// Triangles that nobody can mesh: slivers, folds and very short edges.

#include "tools/wrap/surface.hpp"
#include "tools/wrap/triangle_tree.hpp"

namespace hexpipe::wrap {

struct SliverLimits {
  double shortest_edge;
  double misfit;  // how far the triangles may come from the input, unless they are farther away already
};

// Merges points and flips edges until no triangle is nearly flat, is folded onto its neighbour, or has an edge below
// the limit, as far as that is possible where no other triangle folds and the surface does not cross itself. Returns
// how many such triangles stay. Points that merged are in no triangle afterwards. The surface must be closed and not
// cross itself.
std::size_t remove_slivers(Surface& surface, const TriangleTree& input, const SliverLimits& limits);

}  // namespace hexpipe::wrap
