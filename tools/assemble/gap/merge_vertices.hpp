#pragma once
// Merges vertices that no hex uses into neighbours: fewer tets between the hexes.

#include <cstdint>

#include "tools/assemble/gap/gap_mesh.hpp"

namespace hexpipe::assemble::gap {

// Merges while the objective falls, what pays most first; returns how many vertices are gone. The cells around such a
// vertex have to be valid. `gap` stays valid, and no cell comes to less than least_quality where none around it did.
std::int64_t merge_vertices(GapMesh& gap);

}  // namespace hexpipe::assemble::gap
