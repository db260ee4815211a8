#pragma once
// Reads bundles of other parts of a mesh, beside the one that a stage reads.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_part.hpp"
#include "common/mesh/mesh_piece.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/group_names.hpp"

namespace hexpipe::pipeline {

struct PartBundle {
  std::string name;
  MeshPart part;
  Candidates candidates;
  CandidateKeys keys;
  std::optional<graph::IndependentSet> chosen;  // if there is a solution
  std::vector<nlohmann::ordered_json> history;
};

// Reads a bundle's part with its candidates, its solution and its history, and validates them. Where `wanted` declines
// the part, reads only MeshPart's numbers of part and whole. Throws DataError when it is not a part of a mesh, or a
// wanted one has no candidates with keys.
struct PartHead {
  MeshPart part;
  std::optional<PartBundle> bundle;  // if it was wanted
};
PartHead read_part_bundle(const std::string& path, const std::function<bool(const MeshPart&)>& wanted);

// Reads, one after the other in the order of `paths`, the bundles of the parts that are neighbours of `part`, whose own
// bundle is `source`. Throws DataError when one belongs to another mesh or another number of parts, comes twice, or is
// missing.
void for_each_neighbour(const MeshPart& part, const std::vector<std::string>& paths, const std::string& source,
                        const std::function<void(const PartBundle&)>& visit);

// A piece that assemble made of a part, validated; its mesh is read only with `with_mesh`.
struct PieceBundle {
  std::string name;
  MeshPiece piece;
  MixedMesh mesh;
  std::vector<nlohmann::ordered_json> history;
  formats::GroupNames names;
};
PieceBundle read_piece_bundle(const std::string& path, bool with_mesh);

}  // namespace hexpipe::pipeline
