#pragma once
// Merges vertices that no hex uses into neighbours: fewer tets between the hexes.

#include <cstdint>
#include <span>

#include "tools/assemble/gap_mesh.hpp"

namespace hexpipe {

// Merges while the objective falls, what pays most first; returns how many vertices are gone. Everything around such a
// vertex stays valid, and no cell comes to less than least_merged_quality where none around it was worse.
std::int64_t merge_vertices(GapMesh& gap);

}  // namespace hexpipe
