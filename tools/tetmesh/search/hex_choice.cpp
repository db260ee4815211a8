#include "tools/tetmesh/search/hex_choice.hpp"

#include <algorithm>
#include <bit>

#include "common/candidates/findhex.hpp"
#include "common/conflicts/find_conflicts.hpp"
#include "common/mwis/annealing.hpp"
#include "common/run/random.hpp"

namespace hexpipe {
namespace {

constexpr double temperature = 0;  // nothing that loses stays: two meshes are to differ by their points alone
constexpr const char* source = "the mesh of changed points";

std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) key = mix(key ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0));
  return key;
}

std::uint64_t hash_of(std::span<const Vertex> corners, std::span<const Vec3> points) {
  std::uint64_t key = 0;
  for (const Vertex v : corners) key += hash_of(points[v]);  // in any order
  return key;
}

IndependentSet independent_of(const ConflictGraph& graph, std::span<const std::uint64_t> keys,
                              std::span<const ChosenHex> known) {
  std::vector<std::uint64_t> known_keys;
  for (const ChosenHex& hex : known) known_keys.push_back(hex.key);
  std::ranges::sort(known_keys);
  IndependentSet set;
  std::vector<bool> is_kept_out(keys.size());
  for (std::int32_t i = 0; i < graph.vertex_count(); ++i) {
    if (is_kept_out[i] || !std::ranges::binary_search(known_keys, keys[i])) continue;
    set.push_back(i);
    for (const std::int32_t other : graph.neighbours_of(i)) is_kept_out[other] = true;
  }
  return set;
}

}  // namespace

std::vector<ChosenHex> choose_hexes(const TetMesh& mesh, std::span<const ChosenHex> known, double kicks) {
  const Candidates found = findhex(mesh, {}, source).candidates;
  const ConflictGraph graph = conflict_graph(found, {}, source);
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < found.size(); ++i) keys.push_back(hash_of(found.corners_of(i), mesh.points));
  Annealing annealing(graph, independent_of(graph, keys, known), Random(1));
  const auto chosen_at_first = static_cast<double>(annealing.best().size());
  annealing.run(static_cast<std::int64_t>(kicks * chosen_at_first), temperature, Deadline());
  std::vector<ChosenHex> chosen;
  for (const std::int32_t i : annealing.best()) {
    ChosenHex& hex = chosen.emplace_back(ChosenHex{keys[i], found.volume[i], found.vertices[i], {}});
    for (const auto tets : {found.interior_tets_of(i), found.boundary_tets_of(i)})
      hex.tets.insert(hex.tets.end(), tets.begin(), tets.end());
  }
  return chosen;
}

}  // namespace hexpipe
