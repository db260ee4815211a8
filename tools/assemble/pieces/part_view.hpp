#pragma once
// The view of one part: its mesh with the ghosts, and the cells that the part and its neighbours have chosen there.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_part.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/choice/selection.hpp"

namespace hexpipe::assemble::pieces {

struct PartView {
  MeshPart part;
  TetMesh mesh;
  // The chosen cells whose corners have all their tets here, in the order of a single run.
  Candidates cells;
  CandidateKeys keys;
  // By cell, where it comes from; and the names of the bundles, the part's own first.
  std::vector<choice::CellOrigin> origins;
  std::vector<std::string> bundles;
  // By point: the number of edges to the nearest of the part's own points, at most `furthest` + 1.
  std::vector<std::uint8_t> distance;
};

// Every point up to this distance has all its tets in the part's mesh (docs/definitions.md 5).
inline constexpr std::uint8_t furthest = 6;

// The bundle of a part, with its solution.
struct SolvedPart {
  MeshPart part;
  TetMesh mesh;
  Candidates candidates;
  CandidateKeys keys;
  graph::IndependentSet chosen;
  std::vector<nlohmann::ordered_json> history;
};

// Reads the neighbours one by one. Throws DataError if one is missing, has no solution, or has one of another run.
PartView view_part(SolvedPart own, const std::vector<std::string>& neighbours, const std::string& source);

}  // namespace hexpipe::assemble::pieces
