#pragma once
// Chosen hexes exchanged for other candidates, where hexes gain, or fewer quads stand open against tets.

#include <cstdint>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/boundary_quads.hpp"

namespace hexpipe::assemble::choice {

struct ExchangeCounts {
  std::int64_t hexes_out = 0, hexes_in = 0;
  // Quads of chosen cells, not on the boundary, that no other chosen cell has.
  std::int64_t open_quads_before = 0, open_quads_after = 0;
};

struct Exchange {
  graph::IndependentSet chosen;
  ExchangeCounts counts;
};

// A choice that is worth more than `chosen`, or this: what is summed up is the volume of hexes times a power of their
// quality, less what open quads cost, for each takes a pyramid, and pyramids take room from the hexes beside them.
//
// Hexes come in where they push chosen ones out, or into the room of these: those that their tets form, that are valid,
// and not poorer than both the poorest of `chosen` and what findhex takes where it is not told otherwise. What could
// stand beside `chosen` at its open quads was left out on purpose: neither it nor what would take its room comes in.
// Chosen cells of other kinds stay. `chosen` can be built (build_selection).
Exchange exchange_hexes(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                        const graph::IndependentSet& chosen);

}  // namespace hexpipe::assemble::choice
