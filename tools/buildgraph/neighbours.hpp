#pragma once
// The candidates of a part of a mesh together with those of its neighbours that may be in conflict with them:
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

// Puts together the candidates of `part` and, out of the bundles at `paths`, those of its neighbours that share two
// corners or an interior tet with one of them. Bundles of other parts are left alone. `history` is that of the part's
// own bundle, at `source`. Throws DataError, naming the bundle, when one is of another mesh or another number of parts,
// was found with other options, or is the same part as another; or when a neighbour is missing.
PartCandidates with_neighbours(PartCandidates own, const MeshPart& part,
                               const std::vector<nlohmann::ordered_json>& history,
                               const std::vector<std::string>& paths, const std::string& source);

}  // namespace hexpipe::buildgraph
