#pragma once
// From chosen candidates to a mesh of cells and remaining tets, which does not conform yet.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::choice {

// The bundle that a cell comes from, and its number there, from 0.
struct CellOrigin {
  std::int32_t bundle, number;
};

// Where inputs came from, for messages.
struct InputNames {
  std::string mesh = "mesh", candidates = "candidates", solution = "solution";
  // For cells that are not numbered as in `candidates`: by cell, where it comes from, and the names of the bundles. The
  // first bundle is the one of `candidates` and `solution`.
  std::vector<CellOrigin> origins{};
  std::vector<std::string> bundles{};
};

// The candidate's number as a user of its bundle counts, from 1.
std::string title_of(const InputNames& names, CandidateIndex candidate);

// All of them, ascending.
std::vector<CandidateIndex> all_of(const Candidates& candidates);

// Whether the candidate's tets form it. False for a candidate of another mesh.
bool is_formed_by_its_tets(const TetMesh& mesh, const Candidates& candidates, CandidateIndex candidate);

// Chosen candidates that are known to fit together: only a Selection makes one.
class CheckedChoice {
 public:
  const std::vector<CandidateIndex>& chosen() const { return chosen_; }

 private:
  friend class Selection;
  explicit CheckedChoice(std::vector<CandidateIndex> chosen) : chosen_(std::move(chosen)) {}

  std::vector<CandidateIndex> chosen_;
};

// The mesh with chosen cells in place of their interior tets and of the boundary tets on their quads. A boundary tet
// stays if the quad would lie half on a tagged surface without it.
class Selection {
 public:
  // Throws DataError if the tets of a chosen candidate do not form it (it is of another mesh), or if two chosen ones do
  // not fit together: they share an interior tet, their facets cross, a diagonal of one is an edge of the other, or
  // they lie in two regions without an interface between them.
  Selection(const TetMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
            std::vector<CandidateIndex> chosen, const InputNames& names = {});

  const CheckedChoice& choice() const { return choice_; }
  const std::vector<CandidateIndex>& chosen() const { return choice_.chosen(); }
  const hybrid::HybridMesh& mesh() const { return mesh_; }
  // The mesh takes much memory; the choice alone does not.
  CheckedChoice take_choice() && { return std::move(choice_); }
  hybrid::HybridMesh take_mesh() && { return std::move(mesh_); }

 private:
  CheckedChoice choice_;
  hybrid::HybridMesh mesh_;
};

// A quad of a cell that faces two tets, each with a triangle of it.
struct OpenQuad {
  CellIndex cell;
  int quad;
};

// All open quads, by cell and quad.
std::vector<OpenQuad> open_quads(const hybrid::HybridMesh& mesh);
// Whether quad `i` of the cell faces tets, neither another cell nor the boundary.
bool is_open(const hybrid::HybridMesh& mesh, CellIndex cell, int i);

}  // namespace hexpipe::assemble::choice
