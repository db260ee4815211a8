#include "tools/mesh-part/mesh_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "common/mesh/orientation.hpp"
#include "common/run/progress.hpp"

namespace hexpipe::mesh_part {
namespace {

// How far the tets around a part reach: docs/definitions.md 5.
constexpr int ghost_edges = 6;

// TetOrientation::turns of the whole mesh, which stays as it is.
std::vector<std::int8_t> turns_of(TetMesh& mesh, const char* source) {
  TetOrientation orientation = orient_tets(mesh, source);
  for (std::size_t t = 0; t < orientation.turns.size(); ++t)
    if (orientation.turns[t] != 0) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
  return std::move(orientation.turns);
}

}  // namespace

SplitCounts split(TetMesh mesh, std::int32_t part_count, std::uint64_t seed, const char* source,
                  const std::function<void(const PartOfMesh&)>& take) {
  std::optional<Step> step(std::in_place, "looking for neighbours", 0, 0.2);
  const std::vector<std::int8_t> turns = turns_of(mesh, source);
  const MeshFingerprint whole = fingerprint_of(mesh);
  const TetAdjacency adjacency(mesh, source);
  step.emplace("choosing parts", 0.2, 0.5);
  const Partition parts = partition(mesh, adjacency, part_count, seed, source);
  MeshCutter cutter(mesh, adjacency, parts, part_count, ghost_edges);
  step.emplace("writing parts", 0.5);
  step->expect(part_count);
  SplitCounts counts{.tets = whole.tets, .least = whole.tets, .parts = part_count};
  for (std::int32_t number = 0; number < part_count; ++number) {
    const PartOfMesh part = cutter.cut(number, whole, turns);
    counts.ghosts += static_cast<std::int64_t>(part.mesh.tets.size()) - part.own_tets;
    counts.least = std::min(counts.least, part.own_tets);
    counts.most = std::max(counts.most, part.own_tets);
    counts.most_neighbours = std::max(counts.most_neighbours, static_cast<std::int64_t>(part.part.neighbours.size()));
    take(part);
    step->advance();
  }
  return counts;
}

std::string summary(const SplitCounts& counts) {
  return fmt::format(
      "{} tets in {} parts of {} to {}, with {:.1f} % ghosts and up to {} neighbours each", counts.tets, counts.parts,
      counts.least, counts.most,
      100.0 * static_cast<double>(counts.ghosts) / static_cast<double>(std::max<std::int64_t>(counts.tets, 1)),
      counts.most_neighbours);
}

nlohmann::ordered_json to_json(const SplitCounts& counts) {
  return {{"tets", counts.tets},          {"parts", counts.parts},       {"least_tets", counts.least},
          {"greatest_tets", counts.most}, {"ghost_tets", counts.ghosts}, {"most_neighbours", counts.most_neighbours}};
}

}  // namespace hexpipe::mesh_part
