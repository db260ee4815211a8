#include "common/conflicts/quad_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <span>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/cell_topology.hpp"
#include "common/run/error.hpp"

namespace hexpipe::conflicts {
namespace {

struct QuadOfCandidate {
  VertexKey<4> quad;
  CandidateIndex candidate;
  auto operator<=>(const QuadOfCandidate&) const = default;
};

// Each once, ascending.
std::vector<QuadOfCandidate> quads_of(const Candidates& candidates) {
  std::vector<QuadOfCandidate> all;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    with_topology(candidates.kind[i], [&](auto topology) {
      const auto& corners = candidates.vertices[i];
      for (const auto& [a, b, c, d] : topology.quads)
        all.push_back({key_of<4>({corners[a], corners[b], corners[c], corners[d]}), CandidateIndex(i)});
    });
  std::ranges::sort(all);
  // A candidate of a file may be no cell, and have a quad twice.
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

// Candidates on one side of a quad are in conflict, so the first of them and any on the other side mostly tell.
bool can_be_shared(std::span<const QuadOfCandidate> at_quad, const graph::ConflictGraph& graph) {
  for (std::size_t i = 0; i < at_quad.size(); ++i)
    for (std::size_t j = i + 1; j < at_quad.size(); ++j)
      if (!graph.has_edge(at_quad[i].candidate, at_quad[j].candidate)) return true;
  return false;
}

void append(std::span<const QuadOfCandidate> at_quad, QuadList& list) {
  list.quads.push_back(at_quad.front().quad);
  for (const QuadOfCandidate& at : at_quad) list.candidates_at.push_back(at.candidate);
  list.offsets.push_back(std::ssize(list.candidates_at));
}

double worth_at_best(const Candidates& candidates, CandidateIndex i, WeightKind kind) {
  const bool by_volume =
      kind == WeightKind::volume || kind == WeightKind::quality_volume || kind == WeightKind::mild_quality_volume;
  return by_volume ? candidates.volume[i] : 1;
}

// Makes room for one more neighbour of a candidate for each of its quads: in place, because a large graph has no room
// for a copy. Returns where the new neighbours of each candidate begin.
std::vector<std::int64_t> make_room(const QuadList& quads, graph::ConflictGraph& graph) {
  const std::int32_t candidates = graph.vertex_count();
  std::vector<std::int64_t> places(static_cast<std::size_t>(candidates), 0);
  for (const CandidateIndex i : quads.candidates_at) ++places[i];
  auto shift = std::ssize(quads.candidates_at);  // the quads of the candidates up to this one
  graph.neighbours.resize(graph.neighbours.size() + 2 * static_cast<std::size_t>(shift));
  for (std::int32_t i = candidates; i-- > 0;) {
    const std::int64_t begin = graph.offsets[i], end = graph.offsets[i + 1];
    graph.offsets[i + 1] = end + shift;
    shift -= places[i];
    if (shift > 0)
      std::copy_backward(graph.neighbours.begin() + begin, graph.neighbours.begin() + end,
                         graph.neighbours.begin() + end + shift);
    places[i] = end + shift;
  }
  return places;
}

void check_sum(const graph::ConflictGraph& graph, const char* source) {
  std::int64_t sum = 0;
  for (const std::int64_t weight : graph.weights)
    if (weight < 0 || __builtin_add_overflow(sum, weight, &sum))
      throw DataError::at(source,
                          "expected weights whose sum with the prices of quads fits 64 bits, found too large ones: a "
                          "smaller --weight-scale helps");
}

}  // namespace

InnerQuads find_inner_quads(const Candidates& candidates, const graph::ConflictGraph& graph,
                            const KeySet<3>& boundary) {
  InnerQuads inner;
  const std::vector<QuadOfCandidate> all = quads_of(candidates);
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::find_if(begin, all.end(), [&](const auto& other) { return other.quad != begin->quad; });
    if (can_be_shared({begin, end}, graph))
      append({begin, end}, inner.shared);
    else if (!boundary.empty() && !is_on(boundary, begin->quad))
      append({begin, end}, inner.lonely);
    begin = end;
  }
  return inner;
}

KeySet<3> boundary_of(const TetMesh& mesh, const char* source) {
  const TetAdjacency adjacency(mesh, source);
  KeySet<3> boundary;
  for_each_boundary_facet(mesh, adjacency, [&](const Triangle& facet) { boundary.insert(key_of(facet)); });
  return boundary;
}

std::vector<std::int64_t> prices_of(const QuadList& quads, const Candidates& candidates,
                                    const ConflictOptions& weighing, double share, const char* source) {
  constexpr double too_large = 0x1p61;  // the weight of a quad is twice its price
  std::vector<std::int64_t> prices(quads.size());
  for (std::size_t q = 0; q < prices.size(); ++q) {
    double sum = 0;
    for (std::int64_t i = quads.offsets[q]; i < quads.offsets[q + 1]; ++i)
      sum += worth_at_best(candidates, quads.candidates_at[i], weighing.weight);
    const double mean = sum / static_cast<double>(quads.offsets[q + 1] - quads.offsets[q]);
    const double price = share * weighing.weight_scale * mean;
    if (!(price < too_large))
      throw DataError::at(source, "expected prices of quads below 2^61, found {}: a smaller --weight-scale helps",
                          price);
    prices[q] = std::llround(price);
  }
  return prices;
}

void add_quad_vertices(const QuadList& quads, const std::vector<std::int64_t>& prices, graph::ConflictGraph& graph,
                       const char* source) {
  const std::int32_t candidates = graph.vertex_count();
  if (quads.size() >= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max() - candidates))
    throw DataError::at(source, "expected fewer than 2^31 candidates and quads together, found {} and {}", candidates,
                        quads.size());
  std::vector<std::int64_t> places = make_room(quads, graph);
  std::int64_t end = graph.offsets.back();
  for (std::size_t q = 0; q < quads.size(); ++q) {
    for (std::int64_t i = quads.offsets[q]; i < quads.offsets[q + 1]; ++i) {
      const CandidateIndex candidate = quads.candidates_at[i];
      graph.neighbours[places[candidate]++] = candidates + static_cast<std::int32_t>(q);
      graph.neighbours[end++] = candidate;
      if (__builtin_add_overflow(graph.weights[candidate], prices[q], &graph.weights[candidate]))
        graph.weights[candidate] = std::numeric_limits<std::int64_t>::max();
    }
    graph.offsets.push_back(end);
  }
  for (const std::int64_t price : prices) graph.weights.push_back(2 * price);
  check_sum(graph, source);
}

void pay_for_lonely_quads(const QuadList& lonely, const std::vector<std::int64_t>& prices,
                          graph::ConflictGraph& graph) {
  for (std::size_t q = 0; q < lonely.size(); ++q)
    for (std::int64_t i = lonely.offsets[q]; i < lonely.offsets[q + 1]; ++i) {
      std::int64_t& weight = graph.weights[lonely.candidates_at[i]];
      weight = std::max<std::int64_t>(0, weight - prices[q]);
    }
}

}  // namespace hexpipe::conflicts
