#pragma once
// Points of a surface that could not go where they should: they go as soon as there is room, or merge into a neighbour.

#include <vector>

#include "tools/wrap/surface.hpp"
#include "tools/wrap/triangle_tree.hpp"

namespace hexpipe::wrap {

// Each stray point goes to its target (`targets` has one for each point), or merges into a neighbour that is no stray,
// whichever brings the triangles around it nearest to the input. It stays if they are no nearer then, if a triangle
// folds or loses its area, or if the surface crosses itself. This goes on as long as some point can go. Points that
// merged are in no triangle afterwards. `is_stray` marks the points that stay. The surface must be closed and not cross
// itself.
void settle_strays(Surface& surface, std::vector<char>& is_stray, const std::vector<Vec3>& targets,
                   const TriangleTree& input);

}  // namespace hexpipe::wrap
