#pragma once
// What CGAL does: a closed surface around any triangles, and the check that a surface does not cross itself.

#include <vector>

#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

// A closed, oriented surface without crossings that holds all triangles inside, about `offset` outside them. It does
// not go through what a ball of radius `alpha` does not pass, and its triangles are about that large. (C. Portaneri, M.
// Rouxel-Labbé, M. Hemmer, D. Cohen-Steiner, P. Alliez: Alpha wrapping with an offset, 2022.)
Surface shrink_wrap(const Surface& surface, double alpha, double offset);

// The triangles that meet others in more than the vertices that both have, ascending.
std::vector<std::int32_t> crossing_triangles(const Surface& surface);

}  // namespace hexpipe::wrap
