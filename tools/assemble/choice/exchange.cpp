// The search for a choice of cells knows what each cell is worth alone: of choices with the same hexes, nearly, one may
// have the sheets of hexes go through and another end them against each other. Here the quads between hexes count too.
// Only candidates at quads that stand open take part, so that their conflicts are some of all that there are.

#include "tools/assemble/choice/exchange.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "common/candidates/findhex.hpp"
#include "common/conflicts/find_conflicts.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tools/assemble/choice/exchange_search.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"

namespace hexpipe::assemble::choice {
namespace {

// The numbers below are by the share of the volume that hexes have in the end, in points, in the mean of simp, blub and
// spot with three seeds each, by which it differs by 0.1; with four chosen hexes pushed out at most
// (exchange_search.cpp).

// In hexes of quality 1 and the volume that is usual around. With 0.12 the share is 0.15 less, with 0.08 it is the same
// with a few more pyramids.
constexpr double cost_of_open_quad = 0.1;
// With 0.2 the share is 0.08 less and hexes are worse, with 0.5 it is 0.07 less and hexes are better.
constexpr double power_of_quality = 0.3;
// In the same units as what open quads cost. From 0.03 to 0.003, hardly an annealing, gains six tenths; a start at 0.4,
// or an end at 0.005 or 0.02, as much.
constexpr mwis::local_search::Cooling cooling{.hot = 0.3, .cold = 0.01};
// With 50 the share is 0.04 less, with 100 the same. They take half the time of all that assemble does else.
constexpr std::int64_t moves_a_candidate = 70;
// Half a minute, for parts with millions of candidates.
constexpr std::int64_t most_moves = 100'000'000;
// A candidate takes part when it has so many vertices of open quads. With 1 there are twice as many conflicts and no
// more gain; with 4 seven tenths of the conflicts, and 0.07 points less on spot.
constexpr int least_at_open_quads = 3;
constexpr std::uint64_t seed = 1;
// Of all candidates together: their worths are exact to some digits where the largest is a billion times the smallest,
// and far from the limit.
constexpr double worth_of_all = 0x1p52;

// Calls visit(key) for the quads of a candidate that are not on the boundary.
template <class Visit>
void for_inner_quads(const hybrid::BoundaryQuads& boundary, const Candidates& candidates, std::int32_t i,
                     Visit&& visit) {
  hybrid::HybridCell cell;
  cell.kind = candidates.kind[i];
  cell.corners = candidates.vertices[i];
  for (int k = 0; k < cell.quad_count(); ++k)
    if (const Quad quad = cell.quad(k); !boundary.contains(quad)) visit(key_of(quad));
}

KeySet<4> open_quads(const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                     const graph::IndependentSet& chosen) {
  KeySet<4> open;
  for (const std::int32_t i : chosen)
    for_inner_quads(boundary, candidates, i, [&](const VertexKey<4>& key) {
      if (open.erase(key) == 0) open.insert(key);
    });
  return open;
}

// A candidate that nobody chose may be anything.
bool can_come_in(const TetMesh& mesh, const Candidates& candidates, std::int32_t i, double least_quality) {
  if (candidates.quality[i] < least_quality || !is_formed_by_its_tets(mesh, candidates, i)) return false;
  const auto corners = corner_points(mesh.points, candidates.vertices[i]);
  return is_valid(CellKind::hex, corners);
}

double least_quality_of(const Candidates& candidates, const graph::IndependentSet& chosen) {
  double least = candidates::FindhexOptions{}.min_quality;
  for (const std::int32_t i : chosen)
    if (candidates.kind[i] == CellKind::hex) least = std::min(least, candidates.quality[i]);
  return least;
}

// Candidates, ascending: hexes at open quads, and every chosen cell that has a vertex of these, as cells in conflict
// and cells at one quad have.
std::vector<std::int32_t> those_that_take_part(const TetMesh& mesh, const Candidates& candidates,
                                               const graph::IndependentSet& chosen, const KeySet<4>& open) {
  std::vector<bool> is_at_open(mesh.points.size()), is_at_part(mesh.points.size());
  for (const auto& quad : open)
    for (const Vertex v : quad) is_at_open[v] = true;
  const double least_quality = least_quality_of(candidates, chosen);
  std::vector<std::int32_t> part;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(candidates.size()); ++i) {
    const auto corners = candidates.corners_of(i);
    if (candidates.kind[i] != CellKind::hex || std::ranges::binary_search(chosen, i)) continue;
    if (std::ranges::count_if(corners, [&](Vertex v) { return is_at_open[v]; }) < least_at_open_quads) continue;
    if (!can_come_in(mesh, candidates, i, least_quality)) continue;
    part.push_back(i);
    for (const Vertex v : corners) is_at_part[v] = true;
  }
  const auto others = static_cast<std::ptrdiff_t>(part.size());
  for (const std::int32_t i : chosen)
    if (std::ranges::any_of(candidates.corners_of(i), [&](Vertex v) { return is_at_part[v]; })) part.push_back(i);
  std::ranges::inplace_merge(part, part.begin() + others);
  return part;
}

// Of hexes, by the mesh's points, for what a file says may be anything; 0 for other cells.
std::vector<double> volumes_of(const Candidates& candidates, std::span<const Vec3> points) {
  std::vector<double> volumes(candidates.size());
  for (std::size_t i = 0; i < volumes.size(); ++i)
    if (candidates.kind[i] == CellKind::hex)
      volumes[i] = std::max(0.0, cell_volume(CellKind::hex, corner_points(points, candidates.vertices[i])));
  return volumes;
}

// By vertex: the mean volume of the hexes there, 0 where there are none.
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

// What the candidates that take part are worth, and what quads cost, as integers, so that sums are exact.
class Worth {
 public:
  Worth(const Candidates& part, std::span<const Vec3> points)
      : part_(part), volumes_(volumes_of(part, points)), mean_volumes_(mean_volumes(part, volumes_, points.size())) {
    const double sum = std::accumulate(volumes_.begin(), volumes_.end(), 0.0);
    scale_ = worth_of_all / sum;
    if (std::isfinite(sum) && std::isfinite(scale_)) return;
    // Too large or too small for numbers: nothing is worth anything, and the choice stays.
    scale_ = 0;
    std::ranges::fill(volumes_, 0);
    std::ranges::fill(mean_volumes_, 0);
  }

  std::int64_t of(std::size_t i) const {
    return std::llround(scale_ * volumes_[i] * std::pow(std::clamp(part_.quality[i], 0.0, 1.0), power_of_quality));
  }
  std::int64_t cost_of(const VertexKey<4>& quad) const {
    return std::llround(cost_of_open_quad * scale_ * mean_at(mean_volumes_, quad));
  }
  double usual_around(std::size_t i) const { return scale_ * mean_at(mean_volumes_, part_.corners_of(i)); }

 private:
  const Candidates& part_;
  std::vector<double> volumes_;
  std::vector<double> mean_volumes_;
  double scale_ = 0;
};

// Numbers the inner quads of those that take part, and counts the other chosen cells at them.
void number_quads(const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                  const graph::IndependentSet& chosen, std::span<const std::int32_t> part, const Worth& worth,
                  ExchangeProblem& problem) {
  KeyMap<4, std::int32_t> numbers;
  for (const std::int32_t i : part) {
    auto& row = problem.quads.emplace_back();
    row.fill(ExchangeProblem::none);
    std::size_t filled = 0;
    for_inner_quads(boundary, candidates, i, [&](const VertexKey<4>& key) {
      const auto [entry, added] = numbers.try_emplace(key, static_cast<std::int32_t>(numbers.size()));
      if (added) problem.cost.push_back(worth.cost_of(key));
      row[filled++] = entry->second;
    });
  }
  problem.standing.assign(numbers.size(), 0);
  graph::IndependentSet others;
  std::ranges::set_difference(chosen, part, std::back_inserter(others));
  for (const std::int32_t i : others)
    for_inner_quads(boundary, candidates, i, [&](const VertexKey<4>& key) {
      if (const auto found = numbers.find(key); found != numbers.end()) ++problem.standing[found->second];
    });
}

ExchangeProblem problem_of(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                           const graph::IndependentSet& chosen, std::span<const std::int32_t> part) {
  ExchangeProblem problem;
  Candidates cells = select(candidates, part);
  const Worth worth(cells, mesh.points);
  number_quads(boundary, candidates, chosen, part, worth, problem);
  std::vector<std::int64_t> weights(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    weights[i] = worth.of(i);
    problem.usual.push_back(worth.usual_around(i));
  }
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

// Where something could stand beside what is chosen, it was left out on purpose, and its room with it. A maximal choice
// has no such candidates.
std::vector<std::int32_t> left_out(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                                   const std::vector<std::uint8_t>& is_hex) {
  std::vector<bool> is_kept_out(graph.weights.size());
  for (const std::int32_t i : start) {
    is_kept_out[i] = true;
    for (const std::int32_t u : graph.neighbours_of(i)) is_kept_out[u] = true;
  }
  std::vector<std::int32_t> result;
  for (std::int32_t i = 0; i < graph.vertex_count(); ++i)
    if (is_hex[i] && !is_kept_out[i]) result.push_back(i);
  return result;
}

// By candidate that takes part, 1 where it is not to be exchanged: chosen cells other than hexes, candidates that were
// left out, and what is in conflict with one of these.
std::vector<std::uint8_t> those_that_stay(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                                          const std::vector<std::uint8_t>& is_hex) {
  std::vector<std::uint8_t> stays(graph.weights.size());
  const auto bar = [&](std::int32_t i) {
    stays[i] = 1;
    for (const std::int32_t u : graph.neighbours_of(i)) stays[u] = 1;
  };
  for (const std::int32_t i : start)
    if (!is_hex[i]) bar(i);
  for (const std::int32_t i : left_out(graph, start, is_hex)) bar(i);
  return stays;
}

}  // namespace

Exchange exchange_hexes(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                        const graph::IndependentSet& chosen) {
  const KeySet<4> open = open_quads(boundary, candidates, chosen);
  const auto open_before = static_cast<std::int64_t>(open.size());
  Exchange result{chosen, {.open_quads_before = open_before, .open_quads_after = open_before}};
  const std::vector<std::int32_t> part = those_that_take_part(mesh, candidates, chosen, open);
  graph::IndependentSet start;
  std::vector<std::uint8_t> is_hex;
  for (const std::int32_t i : part) {
    if (std::ranges::binary_search(chosen, i)) start.push_back(static_cast<std::int32_t>(is_hex.size()));
    is_hex.push_back(candidates.kind[i] == CellKind::hex);
  }
  ExchangeProblem problem = problem_of(mesh, boundary, candidates, chosen, part);
  if (!is_independent(problem.graph, start)) return result;
  problem.stays = those_that_stay(problem.graph, start, is_hex);

  ExchangeSearch search(problem, start, Random(seed));
  search.run(std::min(moves_a_candidate * static_cast<std::int64_t>(part.size()), most_moves), cooling);
  graph::IndependentSet before, after, out, in, rest;
  for (const std::int32_t i : start) before.push_back(part[i]);
  for (const std::int32_t i : search.best()) after.push_back(part[i]);
  std::ranges::set_difference(before, after, std::back_inserter(out));
  std::ranges::set_difference(after, before, std::back_inserter(in));
  std::ranges::set_difference(chosen, out, std::back_inserter(rest));
  result.chosen.clear();
  std::ranges::merge(rest, in, std::back_inserter(result.chosen));
  result.counts.hexes_out = static_cast<std::int64_t>(out.size());
  result.counts.hexes_in = static_cast<std::int64_t>(in.size());
  result.counts.open_quads_after = static_cast<std::int64_t>(open_quads(boundary, candidates, result.chosen).size());
  return result;
}

}  // namespace hexpipe::assemble::choice
