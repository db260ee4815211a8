#pragma once
// The steps of restore_shape() after the points of a surface went to the input: points that could not go settle, and
// triangles that nobody can mesh go.

#include <cstddef>
#include <vector>

#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

// Each stray point goes to its target (`targets` has one for each point), or merges into a neighbour that is no stray,
// whichever brings the triangles around it nearest to the input. It stays if they are no nearer then, if a triangle
// folds or loses its area, or if the surface crosses itself. This goes on as long as some point can go. Points that
// merged are in no triangle afterwards. `is_stray` marks the points that stay. The surface must be closed and not cross
// itself.
void settle_strays(Surface& surface, std::vector<char>& is_stray, const std::vector<Vec3>& targets,
                   const TriangleTree& input);

struct CutLimits {
  double feature_angle;  // degrees; edges that turn by more are sharp
  double off;            // a middle of a triangle or an edge farther from the input than this cuts something
  double reach;          // triangles with a point farther from the input than this are left as they are
  double shortest_edge;  // none is made that is shorter
};

// Where triangles between points of the input cut its sharp edges or corners, points go or are added there, edges flip,
// and points merge, whatever brings the surface nearest to the input. Points that merged are in no triangle afterwards.
// The surface must be closed and not cross itself.
void mend_cut_edges(Surface& surface, const TriangleTree& input, const CutLimits& limits);

// Limits for slivers, folds and very short edges.
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
