#include "common/mwis/reduce/sample.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/mwis/reduce/reducer.hpp"
#include "common/mwis/reduce/reduction_log.hpp"

namespace hexpipe::mwis::reduce {
namespace {

constexpr double most_of_a_sparse_graph = 16;
constexpr std::size_t vertices_a_place = 2048;
// Of the sampled vertices, reductions have to decide this share. They decide 0.5 to 3 % of graphs of hexes.
constexpr double least_decided = 0.1;

// The vertices nearest to some that are spread over the graph, ascending.
std::vector<std::int32_t> sample_of(const graph::ConflictGraph& graph, std::int32_t places) {
  std::vector<char> seen(graph.weights.size(), 0);
  std::vector<std::int32_t> sample;
  const auto see = [&](std::int32_t v) {
    if (seen[v] != 0) return;
    seen[v] = 1;
    sample.push_back(v);
  };
  for (std::int32_t i = 0; i < places; ++i) {
    std::size_t next = sample.size();
    const std::size_t end = next + vertices_a_place;
    see(i * (graph.vertex_count() / places));
    for (; next < sample.size() && sample.size() < end; ++next)
      for (const std::int32_t u : graph.neighbours_of(sample[next])) see(u);
  }
  std::ranges::sort(sample);
  return sample;
}

}  // namespace

bool is_sparse(std::int64_t vertices, std::int64_t directed_edges) {
  return static_cast<double>(directed_edges) <=
         most_of_a_sparse_graph * static_cast<double>(std::max<std::int64_t>(1, vertices));
}

bool needs_sample(std::int64_t vertices, std::int64_t directed_edges) {
  return vertices > most_of_a_small_graph && !is_sparse(vertices, directed_edges);
}

bool Sample::decides_enough() const {
  return static_cast<double>(decided) >= least_decided * static_cast<double>(complete);
}

Sample reduce_sample(const graph::ConflictGraph& graph, std::int32_t places, std::span<const char> incomplete,
                     const Deadline& deadline) {
  if (graph.vertex_count() == 0) return {};
  const std::vector<std::int32_t> vertices = sample_of(graph, places);
  const graph::ConflictGraph sample = graph::induced_subgraph(graph, vertices);
  std::vector<char> cut_off(vertices.size(), 0);
  Sample result;
  for (std::int32_t i = 0; i < sample.vertex_count(); ++i) {
    const bool is_incomplete = !incomplete.empty() && incomplete[vertices[i]] != 0;
    cut_off[i] = is_incomplete || sample.degree(i) < graph.degree(vertices[i]) ? 1 : 0;
    result.complete += 1 - cut_off[i];
  }
  ReductionLog log;
  Reducer reducer(sample, log, std::move(cut_off));
  reducer.run(ReductionEffort::quick, deadline);
  result.decided = sample.vertex_count() - reducer.graph().alive_count();
  return result;
}

}  // namespace hexpipe::mwis::reduce
