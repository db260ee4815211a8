#pragma once
// Collects the candidates of a part of a mesh and those of its neighbours that may be in conflict with them:
// docs/definitions.md 5.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_part.hpp"

namespace hexpipe::buildgraph {

struct PartCandidates {
  Candidates candidates;  // in the numbers of the part
  CandidateKeys keys;     // ascending, with owners
};

// Adds to the candidates of `part`, from the bundles at `paths`, its neighbours' candidates that share two corners or
// an interior tet with one of them. Skips bundles of other parts. `history` belongs to the part's own bundle, at
// `source`. Throws DataError, naming the bundle, when one is of another mesh or another number of parts, was made with
// other options, or comes twice; or when a neighbour is missing.
PartCandidates with_neighbours(PartCandidates own, const MeshPart& part,
                               const std::vector<nlohmann::ordered_json>& history,
                               const std::vector<std::string>& paths, const std::string& source);

}  // namespace hexpipe::buildgraph
