#pragma once
// From the chosen candidates to a mesh of cells and remaining tets, not conforming yet.

#include <cstdint>
#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::choice {

// A cell's bundle, of those that cells come from, and its number there, from 0.
struct CellOrigin {
  std::int32_t bundle, number;
};

// Where inputs came from, for messages.
struct InputNames {
  std::string mesh = "mesh", candidates = "candidates", solution = "solution";
  // Of cells from several bundles: by cell, where it is from, and the names of the bundles, of which the first is the
  // one that `candidates` and `solution` are of. Empty: cells have the numbers of these.
  std::vector<CellOrigin> origins{};
  std::vector<std::string> bundles{};
};

// A candidate as its bundle's user counts, from 1.
std::string title_of(const InputNames& names, std::int32_t candidate);

// False for a candidate of another mesh.
bool is_formed_by_its_tets(const TetMesh& mesh, const Candidates& candidates, std::int32_t candidate);

// The chosen cells in place of their interior tets and of the boundary tets on their quads. A boundary tet stays where
// taking it would leave a quad half on a tagged surface.
//
// Throws DataError when a chosen candidate is not what its tets form (a candidate of another mesh) or two chosen ones
// cannot stand together: they share an interior tet, their facets cross, a diagonal of one is an edge of the other, or
// they lie in two regions without an interface between them.
hybrid::HybridMesh build_selection(const TetMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
                                   const graph::IndependentSet& chosen, const InputNames& names = {});

// A quad of a cell that faces two tets, each with a triangle of it.
struct OpenQuad {
  std::int32_t cell;
  int quad;
};

// All of them, by cell and quad.
std::vector<OpenQuad> open_quads(const hybrid::HybridMesh& mesh);
// Whether quad `i` of the cell faces a tet rather than another cell or nothing.
bool is_open(const hybrid::HybridMesh& mesh, std::int32_t cell, int i);

}  // namespace hexpipe::assemble::choice
