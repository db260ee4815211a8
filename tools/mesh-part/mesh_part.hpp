#pragma once
// Splits a mesh into parts: docs/definitions.md 5.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "common/mesh/tet_mesh.hpp"
#include "tools/mesh-part/mesh_cutter.hpp"

namespace hexpipe::mesh_part {

struct SplitCounts {
  std::int64_t tets = 0, ghosts = 0;  // ghosts: of all parts together
  std::int64_t least = 0, most = 0;   // own tets of a part
  std::int64_t most_neighbours = 0;
  std::int32_t parts = 0;
};

// Gives the parts to `take`, one after another. Throws DataError naming `source` when there are fewer tets than parts
// or a facet belongs to more than two tets.
SplitCounts split(TetMesh mesh, std::int32_t part_count, std::uint64_t seed, const char* source,
                  const std::function<void(const PartOfMesh&)>& take);

std::string summary(const SplitCounts& counts);
nlohmann::ordered_json to_json(const SplitCounts& counts);

}  // namespace hexpipe::mesh_part
