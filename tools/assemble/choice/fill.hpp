#pragma once
// Prisms from the tets between the chosen cells.

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/boundary_quads.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"

namespace hexpipe::assemble::choice {

// Merges tets that cells leave into prisms that close as many quads as they open or more: each quad against tets costs
// a pyramid, and pyramids take room from the hexes beside them. Puts the prisms, which fit together and with the cells,
// behind `cells` and returns their number. `standing`: what build_selection made of `mesh` and all of `cells`.
std::int64_t append_filling_prisms(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary,
                                   const hybrid::HybridMesh& standing, Candidates& cells);

}  // namespace hexpipe::assemble::choice
