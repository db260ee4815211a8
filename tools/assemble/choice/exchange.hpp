#pragma once
// Exchanges chosen hexes for other candidates, so that hexes gain or fewer quads are open.

#include <cstdint>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::choice {

struct ExchangeCounts {
  std::int64_t hexes_out = 0, hexes_in = 0;
  // Quads of chosen cells, not on the boundary, that no other chosen cell has.
  std::int64_t open_quads_before = 0, open_quads_after = 0;
};

struct Exchange {
  std::vector<CandidateIndex> chosen;
  ExchangeCounts counts;
};

// Searches for a choice of more worth than the given one, and returns that or the given one. The worth is the sum of
// the volumes of hexes, each times a power of its quality, less a cost for each open quad: an open quad takes a
// pyramid, and pyramids take room from the hexes beside them.
//
// A hex comes in if it pushes chosen ones out or takes their room, if its tets form it, if it is valid, and if it is
// not poorer than both least_hex_quality and the poorest chosen hex. A candidate that could be added to the given
// choice at its open quads was left out on purpose: it stays out, and so does all that would take its room. Chosen
// cells of other kinds stay. The new choice is not checked.
Exchange exchange_hexes(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                        const CheckedChoice& choice);

}  // namespace hexpipe::assemble::choice
