// METIS' multilevel k-way partition (Karypis and Kumar 1998), applied to clusters of the graph. The clusters grow from
// a maximal independent set, which takes the first vertex that fits; each chosen vertex gets the vertices around it
// that no other has yet. Candidates that exclude each other are close together, so clusters are compact, and METIS gets
// a twentieth of the vertices and edges.
#include "tools/lns-mpi/source.hpp"

#include <metis.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "common/run/error.hpp"

namespace hexpipe::lns_mpi {
namespace {

struct Clusters {
  std::vector<std::int32_t> of_vertex;
  std::int32_t count = 0;
};

Clusters cluster(const graph::ConflictGraph& graph) {
  Clusters clusters;
  clusters.of_vertex.assign(graph.weights.size(), no_index);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    if (clusters.of_vertex[v] != no_index) continue;
    const std::int32_t c = clusters.count++;
    clusters.of_vertex[v] = c;
    for (const std::int32_t u : graph.neighbours_of(v))
      if (clusters.of_vertex[u] == no_index) clusters.of_vertex[u] = c;
  }
  return clusters;
}

// The input of METIS: rows, with the number of edges between two clusters.
struct ClusterGraph {
  std::vector<idx_t> offsets{0}, neighbours, edge_weights, sizes;
};

ClusterGraph contract(const graph::ConflictGraph& graph, const Clusters& clusters) {
  std::vector<std::int64_t> begins(static_cast<std::size_t>(clusters.count) + 1, 0);
  for (const std::int32_t c : clusters.of_vertex) ++begins[c + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<std::int32_t> members(graph.weights.size());
  std::vector<std::int64_t> next(begins.begin(), begins.end() - 1);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) members[next[clusters.of_vertex[v]]++] = v;

  ClusterGraph result;
  std::vector<idx_t> place(static_cast<std::size_t>(clusters.count), no_index);
  for (std::int32_t c = 0; c < clusters.count; ++c) {
    const auto row = static_cast<idx_t>(result.neighbours.size());
    for (std::int64_t i = begins[c]; i < begins[c + 1]; ++i)
      for (const std::int32_t u : graph.neighbours_of(members[i])) {
        const std::int32_t d = clusters.of_vertex[u];
        if (d == c) continue;
        if (place[d] < row) {
          place[d] = static_cast<idx_t>(result.neighbours.size());
          result.neighbours.push_back(d);
          result.edge_weights.push_back(0);
        }
        ++result.edge_weights[place[d]];
      }
    result.sizes.push_back(static_cast<idx_t>(begins[c + 1] - begins[c]));
    result.offsets.push_back(static_cast<idx_t>(result.neighbours.size()));
  }
  return result;
}

std::vector<idx_t> partition(ClusterGraph& graph, std::int32_t blocks) {
  auto vertices = static_cast<idx_t>(graph.sizes.size());
  idx_t constraints = 1, parts = blocks, cut = 0;
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> part(graph.sizes.size(), 0);
  if (METIS_PartGraphKway(&vertices, &constraints, graph.offsets.data(), graph.neighbours.data(), graph.sizes.data(),
                          nullptr, graph.edge_weights.data(), &parts, nullptr, nullptr, options.data(), &cut,
                          part.data()) != METIS_OK)
    throw DataError("the graph cannot be cut: METIS failed");
  return part;
}

}  // namespace

std::vector<std::int32_t> cut_into_blocks(const graph::ConflictGraph& graph, std::int32_t blocks) {
  const Clusters clusters = cluster(graph);
  std::vector<std::int32_t> block(graph.weights.size(), 0);
  if (blocks <= 1) return block;
  if (clusters.count <= blocks) {
    std::ranges::transform(clusters.of_vertex, block.begin(), [&](std::int32_t c) { return c; });
    return block;
  }
  ClusterGraph contracted = contract(graph, clusters);
  const std::vector<idx_t> part = partition(contracted, blocks);
  std::ranges::transform(clusters.of_vertex, block.begin(), [&](std::int32_t c) { return part[c]; });
  return block;
}

}  // namespace hexpipe::lns_mpi
