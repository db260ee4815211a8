#pragma once
// Makes prisms from the tets between the chosen cells.

#include <cstdint>

#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::choice {

struct PrismFilling {
  Candidates cells;         // the chosen candidates in their order, then the prisms
  std::int64_t prisms = 0;  // how many
};

// Merges tets that the chosen cells leave into prisms that close at least as many quads as they open: each quad that
// faces tets takes a pyramid, and pyramids take room from the hexes beside them. The prisms fit together and with the
// chosen cells.
PrismFilling fill_with_prisms(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                              const Selection& selection);

}  // namespace hexpipe::assemble::choice
