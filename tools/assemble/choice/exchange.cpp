// The search for a choice of cells knows only the worth of each cell alone. In one of two choices with nearly the same
// hexes, sheets of hexes may go through, and in the other end against each other. Here the quads between hexes count,
// too. Only candidates at open quads take part, so that few of all conflicts have to be found.

#include "tools/assemble/choice/exchange.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "common/conflicts/find_conflicts.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/progress.hpp"
#include "tools/assemble/choice/exchange_search.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"

namespace hexpipe::assemble::choice {
namespace {

// The gains and losses below are points of the share that hexes have of the volume in the end: the mean over simp, blub
// and spot with three seeds each, between which it differs by 0.1. At most four chosen hexes were pushed out
// (exchange_search.cpp).

// In hexes of quality 1 and of the usual volume around. 0.12 loses 0.15; 0.08 gives the same share with a few more
// pyramids.
constexpr double cost_of_open_quad = 0.1;
// In the units of cost_of_open_quad. Cooling from 0.03 to 0.003, hardly an annealing, gives six tenths of the gain; a
// start at 0.4, or an end at 0.005 or 0.02, gives as much.
constexpr mwis::local_search::Cooling cooling{.hot = 0.3, .cold = 0.01};
// 50 lose 0.04, 100 gain nothing. 70 take half as long as the rest of assemble.
constexpr std::int64_t moves_a_candidate = 70;
// Half a minute, for models with millions of candidates.
constexpr std::int64_t most_moves = 100'000'000;
// A candidate takes part if it has at least this many vertices of open quads. 1 makes twice as many conflicts and gains
// nothing; 4 makes seven tenths of the conflicts and loses 0.07 on spot.
constexpr int least_at_open_quads = 3;
constexpr std::uint64_t seed = 1;
// The worth of all candidates together: far from the limit, and even where the largest is worth a billion times the
// smallest, exact to some digits.
constexpr double worth_of_all = 0x1p52;

// Calls visit(key) for the quads of a candidate that are not on the boundary.
template <class Visit>
void for_inner_quads(const hybrid::BoundaryQuads& boundary, const Candidates& candidates, CandidateIndex i,
                     Visit&& visit) {
  hybrid::HybridCell cell;
  cell.kind = candidates.kind[i];
  cell.corners = candidates.vertices[i];
  for (int k = 0; k < cell.quad_count(); ++k)
    if (const Quad quad = cell.quad(k); !boundary.contains(quad)) visit(key_of(quad));
}

KeySet<4> open_quads(const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                     const std::vector<CandidateIndex>& chosen) {
  KeySet<4> open;
  for (const CandidateIndex i : chosen)
    for_inner_quads(boundary, candidates, i, [&](const VertexKey<4>& key) {
      if (open.erase(key) == 0) open.insert(key);
    });
  return open;
}

// Nobody has checked a candidate that is not chosen: it may be anything.
bool can_come_in(const TetMesh& mesh, const Candidates& candidates, CandidateIndex i, double least_quality) {
  if (candidates.quality[i] < least_quality || !is_formed_by_its_tets(mesh, candidates, i)) return false;
  const auto corners = corner_points(mesh.points, candidates.vertices[i]);
  return is_valid(CellKind::hex, corners);
}

double least_quality_of(const Candidates& candidates, const std::vector<CandidateIndex>& chosen) {
  double least = least_hex_quality;
  for (const CandidateIndex i : chosen)
    if (candidates.kind[i] == CellKind::hex) least = std::min(least, candidates.quality[i]);
  return least;
}

// The candidates that take part.
using Participants = IndexedVector<Participant, CandidateIndex>;

// All that take part, ascending: hexes at open quads, and all chosen cells that have a vertex of one of these. Cells in
// conflict share a vertex, and so do cells at one quad.
Participants find_participants(const TetMesh& mesh, const Candidates& candidates,
                               const std::vector<CandidateIndex>& chosen, const KeySet<4>& open) {
  std::vector<bool> is_at_open(mesh.points.size()), is_at_participant(mesh.points.size());
  for (const auto& quad : open)
    for (const Vertex v : quad) is_at_open[v] = true;
  const double least_quality = least_quality_of(candidates, chosen);
  Participants participants;
  for (const auto i : indices<CandidateIndex>(candidates.size())) {
    const auto corners = candidates.corners_of(i);
    if (candidates.kind[i] != CellKind::hex || std::ranges::binary_search(chosen, i)) continue;
    if (std::ranges::count_if(corners, [&](Vertex v) { return is_at_open[v]; }) < least_at_open_quads) continue;
    if (!can_come_in(mesh, candidates, i, least_quality)) continue;
    participants.push_back(i);
    for (const Vertex v : corners) is_at_participant[v] = true;
  }
  const auto others = static_cast<std::ptrdiff_t>(participants.size());
  for (const CandidateIndex i : chosen)
    if (std::ranges::any_of(candidates.corners_of(i), [&](Vertex v) { return is_at_participant[v]; }))
      participants.push_back(i);
  std::ranges::inplace_merge(participants, participants.begin() + others);
  return participants;
}

// By candidate: the volume of a hex by the mesh's points, because a file may say anything; 0 for other cells.
std::vector<double> volumes_of(const Candidates& candidates, std::span<const Vec3> points) {
  std::vector<double> volumes(candidates.size());
  for (std::size_t i = 0; i < volumes.size(); ++i)
    if (candidates.kind[i] == CellKind::hex)
      volumes[i] = std::max(0.0, cell_volume(CellKind::hex, corner_points(points, candidates.vertices[i])));
  return volumes;
}

// By vertex: the mean volume of the hexes there, 0 if there are none.
std::vector<double> mean_volumes(const Candidates& candidates, const std::vector<double>& volumes, std::size_t points) {
  std::vector<double> mean(points);
  std::vector<std::int32_t> hexes(points);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates.kind[i] != CellKind::hex) continue;
    for (const Vertex v : candidates.corners_of(i)) {
      mean[v] += volumes[i];
      ++hexes[v];
    }
  }
  for (std::size_t v = 0; v < points; ++v)
    if (hexes[v] > 0) mean[v] /= hexes[v];
  return mean;
}

double mean_at(const std::vector<double>& by_vertex, std::span<const Vertex> vertices) {
  double sum = 0;
  for (const Vertex v : vertices) sum += by_vertex[v];
  return sum / static_cast<double>(vertices.size());
}

// The worth of candidates and the cost of quads as integers, so that sums are exact.
class Worth {
 public:
  Worth(const Candidates& cells, std::span<const Vec3> points)
      : cells_(cells),
        volumes_(volumes_of(cells, points)),
        mean_volumes_(mean_volumes(cells, volumes_, points.size())) {
    const double sum = std::accumulate(volumes_.begin(), volumes_.end(), 0.0);
    scale_ = worth_of_all / sum;
    if (std::isfinite(sum) && std::isfinite(scale_)) return;
    // Too large or too small for numbers: nothing is worth anything, and the choice stays.
    scale_ = 0;
    std::ranges::fill(volumes_, 0);
    std::ranges::fill(mean_volumes_, 0);
  }

  std::int64_t of(std::size_t i) const {
    return std::llround(scale_ * volumes_[i] *
                        std::pow(std::clamp(cells_.quality[i], 0.0, 1.0), conflicts::mild_power_of_quality));
  }
  std::int64_t cost_of(const VertexKey<4>& quad) const {
    return std::llround(cost_of_open_quad * scale_ * mean_at(mean_volumes_, quad));
  }
  double usual_around(std::size_t i) const { return scale_ * mean_at(mean_volumes_, cells_.corners_of(i)); }

 private:
  const Candidates& cells_;
  std::vector<double> volumes_;
  std::vector<double> mean_volumes_;
  double scale_ = 0;
};

// Numbers the inner quads of the participants, and counts the other chosen cells at them.
void number_quads(const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                  const std::vector<CandidateIndex>& chosen, const Participants& participants, const Worth& worth,
                  ExchangeProblem& problem) {
  KeyMap<4, QuadIndex> numbers;
  numbers.reserve(3 * participants.size());
  for (const CandidateIndex i : participants) {
    auto& row = problem.quads.emplace_back();
    row.fill(no_index);
    std::size_t filled = 0;
    for_inner_quads(boundary, candidates, i, [&](const VertexKey<4>& key) {
      const auto [entry, added] = numbers.try_emplace(key, QuadIndex(numbers.size()));
      if (added) problem.cost.push_back(worth.cost_of(key));
      row[filled++] = entry->second;
    });
  }
  problem.fixed_cells.assign(numbers.size(), 0);
  std::vector<CandidateIndex> others;
  std::ranges::set_difference(chosen, participants, std::back_inserter(others));
  for (const CandidateIndex i : others)
    for_inner_quads(boundary, candidates, i, [&](const VertexKey<4>& key) {
      if (const auto found = numbers.find(key); found != numbers.end()) ++problem.fixed_cells[found->second];
    });
}

ExchangeProblem problem_of(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                           const std::vector<CandidateIndex>& chosen, const Participants& participants) {
  ExchangeProblem problem;
  Candidates cells = select(candidates, participants);
  const Worth worth(cells, mesh.points);
  number_quads(boundary, candidates, chosen, participants, worth, problem);
  std::vector<std::int64_t> weights(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    weights[i] = worth.of(i);
    problem.usual.push_back(worth.usual_around(i));
  }
  const Step step(nullptr, 0.3, 0.5);
  problem.graph = conflicts::conflict_graph(std::move(cells),
                                            {.weight = conflicts::WeightKind::count, .weight_scale = 1}, "candidates");
  problem.graph.weights = std::move(weights);
  return problem;
}

bool is_independent(const graph::ConflictGraph& graph, const graph::IndependentSet& set) {
  std::vector<bool> is_in(graph.weights.size());
  for (const std::int32_t i : set) is_in[i] = true;
  return std::ranges::none_of(set, [&](std::int32_t i) {
    return std::ranges::any_of(graph.neighbours_of(i), [&](std::int32_t u) { return is_in[u]; });
  });
}

// Hexes that could be added to the choice: they were left out on purpose, and their room with them. A maximal choice
// has none.
std::vector<Participant> left_out(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                                  const IndexedVector<Participant, std::uint8_t>& is_hex) {
  std::vector<bool> is_kept_out(graph.weights.size());
  for (const std::int32_t i : start) {
    is_kept_out[i] = true;
    for (const std::int32_t u : graph.neighbours_of(i)) is_kept_out[u] = true;
  }
  std::vector<Participant> result;
  for (const auto i : indices<Participant>(is_hex.size()))
    if (is_hex[i] && !is_kept_out[i]) result.push_back(i);
  return result;
}

// 1 for a participant that stays in or out. Chosen cells other than hexes stay, hexes that were left out, and all that
// are in conflict with one of these.
IndexedVector<Participant, std::uint8_t> find_staying(const graph::ConflictGraph& graph,
                                                      const graph::IndependentSet& start,
                                                      const IndexedVector<Participant, std::uint8_t>& is_hex) {
  IndexedVector<Participant, std::uint8_t> stays(graph.weights.size());
  const auto bar = [&](Participant i) {
    stays[i] = 1;
    for (const auto u : as_indices<Participant>(graph.neighbours_of(i))) stays[u] = 1;
  };
  for (const auto i : as_indices<Participant>(start))
    if (!is_hex[i]) bar(i);
  for (const Participant i : left_out(graph, start, is_hex)) bar(i);
  return stays;
}

// `chosen` with `after` in place of `before`, all ascending.
Exchange replaced(const std::vector<CandidateIndex>& chosen, const std::vector<CandidateIndex>& before,
                  const std::vector<CandidateIndex>& after) {
  std::vector<CandidateIndex> out, in, rest;
  std::ranges::set_difference(before, after, std::back_inserter(out));
  std::ranges::set_difference(after, before, std::back_inserter(in));
  std::ranges::set_difference(chosen, out, std::back_inserter(rest));
  Exchange result;
  std::ranges::merge(rest, in, std::back_inserter(result.chosen));
  result.counts.hexes_out = static_cast<std::int64_t>(out.size());
  result.counts.hexes_in = static_cast<std::int64_t>(in.size());
  return result;
}

}  // namespace

Exchange exchange_hexes(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                        const CheckedChoice& choice) {
  const std::vector<CandidateIndex>& chosen = choice.chosen();
  const KeySet<4> open = open_quads(boundary, candidates, chosen);
  const auto open_before = static_cast<std::int64_t>(open.size());
  const Participants participants = find_participants(mesh, candidates, chosen, open);
  graph::IndependentSet start;
  IndexedVector<Participant, std::uint8_t> is_hex;
  for (const CandidateIndex i : participants) {
    if (std::ranges::binary_search(chosen, i)) start.push_back(static_cast<std::int32_t>(is_hex.size()));
    is_hex.push_back(candidates.kind[i] == CellKind::hex);
  }
  ExchangeProblem problem = problem_of(mesh, boundary, candidates, chosen, participants);
  if (!is_independent(problem.graph, start))
    return {chosen, {.open_quads_before = open_before, .open_quads_after = open_before}};
  problem.stays = find_staying(problem.graph, start, is_hex);

  ExchangeSearch search(problem, start, Random(seed));
  search.run(std::min(moves_a_candidate * static_cast<std::int64_t>(participants.size()), most_moves), cooling);
  const graph::IndependentSet best = search.best();
  std::vector<CandidateIndex> before, after;
  for (const auto i : as_indices<Participant>(start)) before.push_back(participants[i]);
  for (const auto i : as_indices<Participant>(best)) after.push_back(participants[i]);
  Exchange result = replaced(chosen, before, after);
  result.counts.open_quads_before = open_before;
  result.counts.open_quads_after = static_cast<std::int64_t>(open_quads(boundary, candidates, result.chosen).size());
  return result;
}

}  // namespace hexpipe::assemble::choice
