#pragma once
// Points of a surface that could not go where they should: they go as soon as there is room, or merge into a neighbour.

#include <vector>

#include "tools/wrap/surface.hpp"
#include "tools/wrap/triangle_tree.hpp"

namespace hexpipe::wrap {

// Each stray point goes to its target (`targets`, of each point), or merges into a neighbour that is no stray: what
// brings the triangles around it nearest to the input, if that is nearer than they are, no triangle folds or loses its
// area, and the surface does not cross itself. As long as some can. Points that merged are in no triangle afterwards.
// `is_stray` keeps those that found no way. The surface must be closed and not cross itself.
void settle_strays(Surface& surface, std::vector<char>& is_stray, const std::vector<Vec3>& targets,
                   const TriangleTree& input);

}  // namespace hexpipe::wrap
