#pragma once
// Merges two vertices that no hex uses, wherever between them is best: pyramids share their apexes.

#include <cstdint>

#include "tools/assemble/gap/gap_mesh.hpp"

namespace hexpipe::assemble::gap {

// Two free vertices that have a cell in common, or cells on both sides of a facet, become one, at the place where the
// worst cell around it is best, while the objective falls, what pays most first; returns how many vertices are gone.
// `gap` has to be valid, and stays so. `neighbours_yield`: vertices inside around the two move, too, those of chosen
// cells among them (patch.hpp).
std::int64_t merge_stars(GapMesh& gap, bool neighbours_yield = false);

}  // namespace hexpipe::assemble::gap
