#pragma once
// Bundles of parts of a mesh, read beside the one that a stage reads.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_part.hpp"

namespace hexpipe {

struct PartBundle {
  std::string name;
  MeshPart part;
  Candidates candidates;
  CandidateKeys keys;
  std::vector<nlohmann::ordered_json> history;
};

// Reads what a bundle has of a part, its candidates and its history, all validated; of a part that `wanted` declines,
// nothing but MeshPart's numbers of part and whole. Throws DataError when it is no part of a mesh, or one that is
// wanted has no candidates with keys.
struct PartHead {
  MeshPart part;
  std::optional<PartBundle> bundle;  // where it was wanted
};
PartHead read_part_bundle(const std::string& path, const std::function<bool(const MeshPart&)>& wanted);

// The last entry of a tool, without the counts that are its part's own: version and options. Null where there is none.
nlohmann::ordered_json settings_of(const std::string& tool, const std::vector<nlohmann::ordered_json>& history);

}  // namespace hexpipe
