#include "tools/buildgraph/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace hexpipe {

GraphSummary summarize(const ConflictGraph& graph) {
  GraphSummary summary;
  summary.vertices = graph.vertex_count();
  summary.edges = graph.edge_count();
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    summary.max_degree = std::max(summary.max_degree, graph.degree(v));
  const double pairs = 0.5 * static_cast<double>(summary.vertices) * static_cast<double>(summary.vertices - 1);
  summary.density = pairs > 0 ? static_cast<double>(summary.edges) / pairs : 0;
  summary.total_weight = std::accumulate(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
  summary.without_weight = std::count(graph.weights.begin(), graph.weights.end(), 0);
  return summary;
}

std::vector<std::string> warnings_about(const GraphSummary& summary) {
  if (summary.without_weight == 0) return {};
  return {fmt::format("{} of {} weights are rounded to 0: a greater --weight-scale keeps them apart",
                      summary.without_weight, summary.vertices)};
}

std::string summary_line(const GraphSummary& summary) {
  return fmt::format("{} vertices, {} edges, greatest degree {}, density {:.3g}, total weight {}", summary.vertices,
                     summary.edges, summary.max_degree, summary.density, summary.total_weight);
}

nlohmann::ordered_json to_json(const GraphSummary& summary) {
  return {{"vertices", summary.vertices},
          {"edges", summary.edges},
          {"max_degree", summary.max_degree},
          {"density", summary.density},
          {"total_weight", summary.total_weight}};
}

}  // namespace hexpipe
