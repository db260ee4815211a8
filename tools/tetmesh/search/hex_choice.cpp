#include "tools/tetmesh/search/hex_choice.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "common/candidates/findhex.hpp"
#include "common/conflicts/find_conflicts.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/reorder.hpp"
#include "common/mwis/local_search/annealing.hpp"
#include "common/run/random.hpp"

namespace hexpipe::tetmesh::search {
namespace {

constexpr double temperature = 0;  // no loss is accepted: two meshes must differ by their points alone
constexpr const char* source = "the mesh of changed points";
// Compared with the quality over the whole element, this takes a tenth of the time here, and hardly ever decides
// otherwise.
constexpr candidates::CandidateQuality quality = candidates::CandidateQuality::corner;

// The hexes with a corner that is touched. A cell is found at its lowest vertex: the touched vertices come first here.
Candidates hexes_at(const std::vector<bool>& is_touched, const TetMesh& mesh) {
  std::vector<Vertex> order(mesh.points.size()), place_of(mesh.points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto end_of_touched =
      std::stable_partition(order.begin(), order.end(), [&](Vertex v) { return is_touched[v]; });
  for (std::size_t i = 0; i < order.size(); ++i) place_of[order[i]] = static_cast<Vertex>(i);
  TetMesh ordered = mesh;
  reorder(ordered.points, order);
  const auto renumber = [&](auto& cells) {
    for (auto& cell : cells)
      for (Vertex& v : cell) v = place_of[v];
  };
  renumber(ordered.tets);
  renumber(ordered.triangles);
  candidates::SearchScope scope;
  scope.begins_at.resize(order.size());
  std::fill_n(scope.begins_at.begin(), end_of_touched - order.begin(), true);
  Candidates found = candidates::findhex(std::move(ordered), {.quality = quality}, source, scope).candidates;
  for (auto& corners : found.vertices)
    for (Vertex& v : corners) v = order[v];
  return found;
}

void append(Candidates& to, const ChosenHex& hex) {
  to.vertices.push_back(hex.corners);
  to.kind.push_back(CellKind::hex);
  to.quality.push_back(hex.quality);
  to.volume.push_back(hex.volume);
  to.tets.insert(to.tets.end(), hex.interior_tets.begin(), hex.interior_tets.end());
  to.tet_offsets.push_back(static_cast<std::int64_t>(to.tets.size()));
  to.boundary_tets.insert(to.boundary_tets.end(), hex.boundary_tets.begin(), hex.boundary_tets.end());
  to.boundary_tet_offsets.push_back(static_cast<std::int64_t>(to.boundary_tets.size()));
}

// Leaves out hexes that conflict with one before them, where the change has brought them into conflict.
graph::IndependentSet independent_of(std::span<const std::int32_t> wanted, const graph::ConflictGraph& graph) {
  std::vector<bool> is_kept_out(graph.weights.size());
  graph::IndependentSet set;
  for (const std::int32_t i : wanted) {
    if (is_kept_out[i]) continue;
    set.push_back(i);
    for (const std::int32_t other : graph.neighbours_of(i)) is_kept_out[other] = true;
  }
  std::ranges::sort(set);
  return set;
}

// Appends the best set found from the wanted one.
void append_best(const Candidates& found, std::span<const std::int32_t> wanted, double kicks,
                 std::vector<ChosenHex>& chosen) {
  const graph::ConflictGraph graph = conflicts::conflict_graph(found, {}, source);
  mwis::local_search::Annealing annealing(graph, independent_of(wanted, graph), Random(1));
  const auto chosen_at_first = static_cast<double>(annealing.best().size());
  annealing.run(static_cast<std::int64_t>(kicks * chosen_at_first), temperature, Deadline());
  for (const std::int32_t i : annealing.best()) {
    const auto interior = found.interior_tets_of(i), boundary = found.boundary_tets_of(i);
    chosen.push_back({.volume = found.volume[i],
                      .quality = found.quality[i],
                      .corners = found.vertices[i],
                      .interior_tets{interior.begin(), interior.end()},
                      .boundary_tets{boundary.begin(), boundary.end()}});
  }
}

// Nothing if it lost a corner.
std::optional<std::array<Vertex, 8>> corners_now(const ChosenHex& hex, const MeshChange& change) {
  std::array<Vertex, 8> corners{};
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = change.vertex_now[hex.corners[i]];
  if (std::ranges::count(corners, no_index) > 0) return std::nullopt;
  return corners;
}

// For a hex without a touched corner, so that all of its tets stay.
ChosenHex unchanged(const ChosenHex& before, const std::array<Vertex, 8>& corners, const MeshChange& change) {
  ChosenHex hex = before;
  hex.corners = corners;
  for (std::vector<TetIndex>* tets : {&hex.interior_tets, &hex.boundary_tets}) {
    for (TetIndex& t : *tets) t = change.tet_now[t];
    std::ranges::sort(*tets);
  }
  return hex;
}

}  // namespace

std::vector<ChosenHex> choose_hexes(const TetMesh& mesh, double kicks) {
  std::vector<ChosenHex> chosen;
  append_best(candidates::findhex(mesh, {.quality = quality}, source).candidates, {}, kicks, chosen);
  return chosen;
}

std::vector<ChosenHex> choose_hexes_again(const TetMesh& mesh, const MeshChange& change,
                                          std::span<const ChosenHex> before, double kicks) {
  Candidates open = hexes_at(change.is_touched, mesh);
  std::vector<bool> is_beside(mesh.points.size());
  for (const auto& corners : open.vertices)
    for (const Vertex v : corners) is_beside[v] = true;
  const std::size_t touched_count = open.size();
  std::vector<ChosenHex> chosen;
  KeySet<8> known;
  for (const ChosenHex& hex : before) {
    const auto corners = corners_now(hex, change);
    if (!corners) continue;
    const auto any = [&](const std::vector<bool>& marked) {
      return std::ranges::any_of(*corners, [&](Vertex v) { return marked[v]; });
    };
    if (any(change.is_touched))
      known.insert(key_of(*corners));
    else if (any(is_beside))
      append(open, unchanged(hex, *corners, change));
    else
      chosen.push_back(unchanged(hex, *corners, change));
  }
  // Untouched hexes fit together as before.
  std::vector<std::int32_t> wanted;
  for (std::size_t i = touched_count; i < open.size(); ++i) wanted.push_back(static_cast<std::int32_t>(i));
  for (std::size_t i = 0; i < touched_count; ++i)
    if (known.contains(key_of(open.vertices[i]))) wanted.push_back(static_cast<std::int32_t>(i));
  append_best(open, wanted, kicks, chosen);
  return chosen;
}

}  // namespace hexpipe::tetmesh::search
