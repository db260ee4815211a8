#include "tools/buildgraph/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace hexpipe::buildgraph {

GraphSummary summarize(const BuildgraphResult& result) {
  const graph::ConflictGraph& graph = result.product.graph;
  GraphSummary summary;
  summary.dominated = result.dominated;
  if (const auto& quads = result.product.quads) summary.quads = std::ssize(*quads);
  if (const auto& cover = result.product.cover) {
    summary.cliques = cover->size();
    summary.clique_members = static_cast<std::int64_t>(cover->members.size());
  }
  summary.vertices = graph.vertex_count();
  summary.edges = graph.edge_count();
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    summary.max_degree = std::max(summary.max_degree, graph.degree(v));
  const double pairs = 0.5 * static_cast<double>(summary.vertices) * static_cast<double>(summary.vertices - 1);
  summary.density = pairs > 0 ? static_cast<double>(summary.edges) / pairs : 0;
  summary.total_weight = std::accumulate(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
  // Candidates that pay for quads may come down to 0 themselves; prices tell whether the scale is too small then.
  const auto first = summary.quads ? graph.weights.end() - *summary.quads : graph.weights.begin();
  summary.without_weight = std::count(first, graph.weights.end(), 0);
  return summary;
}

std::vector<std::string> warnings_about(const GraphSummary& summary) {
  if (summary.without_weight == 0) return {};
  return {fmt::format("{} of {} weights{} are rounded to 0: a greater --weight-scale keeps them apart",
                      summary.without_weight, summary.quads.value_or(summary.vertices),
                      summary.quads ? " of quads" : "")};
}

std::vector<std::string> summary_lines(const GraphSummary& summary) {
  std::vector<std::string> lines;
  if (summary.dominated) {
    const std::int64_t all = summary.vertices + *summary.dominated;
    lines.push_back(
        fmt::format("{} of {} candidates are left out as dominated ({:.1f} %)", *summary.dominated, all,
                    all > 0 ? 100.0 * static_cast<double>(*summary.dominated) / static_cast<double>(all) : 0.0));
  }
  lines.push_back(fmt::format("{} vertices, {} edges, greatest degree {}, density {:.3g}, total weight {}",
                              summary.vertices, summary.edges, summary.max_degree, summary.density,
                              summary.total_weight));
  if (summary.quads)
    lines.push_back(fmt::format("{} of the vertices are quads that candidates can share", *summary.quads));
  if (summary.cliques)
    lines.push_back(fmt::format("the edges are covered by {} cliques of {} vertices together", *summary.cliques,
                                *summary.clique_members));
  return lines;
}

nlohmann::ordered_json history_of(const GraphSummary& summary) {
  nlohmann::ordered_json history{{"vertices", summary.vertices}, {"edges", summary.edges}};
  if (summary.quads) history["quads"] = *summary.quads;
  if (summary.dominated) history["dominated"] = *summary.dominated;
  if (summary.cliques) history["cliques"] = *summary.cliques;
  return history;
}

nlohmann::ordered_json to_json(const GraphSummary& summary) {
  nlohmann::ordered_json all = history_of(summary);
  if (summary.cliques) all["clique_members"] = *summary.clique_members;
  all["max_degree"] = summary.max_degree;
  all["density"] = summary.density;
  all["total_weight"] = summary.total_weight;
  return all;
}

}  // namespace hexpipe::buildgraph
