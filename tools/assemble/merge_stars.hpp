#pragma once
// Merges two vertices that no hex uses, wherever between them that is best: fewer pyramids' apexes.

#include <cstdint>

#include "tools/assemble/gap_mesh.hpp"

namespace hexpipe {

// Two free vertices with an edge or facet's breadth between them become one, at the place where the worst cell around
// it is best, while the objective falls, what pays most first; returns how many vertices are gone.
std::int64_t merge_stars(GapMesh& gap);

}  // namespace hexpipe
