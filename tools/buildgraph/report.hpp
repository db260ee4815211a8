#pragma once
// What buildgraph says of a graph: warnings, a line for -v, and JSON for --stats.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe {

struct GraphSummary {
  std::int64_t vertices = 0, edges = 0;
  std::int64_t max_degree = 0;
  double density = 0;  // edges / pairs of vertices
  std::int64_t total_weight = 0;
  std::int64_t without_weight = 0;  // vertices whose weight is 0
};

GraphSummary summarize(const ConflictGraph& graph);
std::vector<std::string> warnings_about(const GraphSummary& summary);
std::string summary_line(const GraphSummary& summary);
nlohmann::ordered_json to_json(const GraphSummary& summary);

}  // namespace hexpipe
