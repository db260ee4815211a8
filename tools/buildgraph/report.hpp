#pragma once
// The reports of buildgraph: warnings, lines for -v, and JSON for --stats and the history.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/buildgraph/buildgraph.hpp"

namespace hexpipe::buildgraph {

struct GraphSummary {
  std::int64_t vertices = 0, edges = 0;
  std::optional<std::int64_t> quads;  // among the vertices, if --quad-reward makes some
  std::int64_t max_degree = 0;
  double density = 0;  // edges / pairs of vertices
  std::int64_t total_weight = 0;
  std::int64_t without_weight = 0;                      // vertices whose weight is 0
  std::optional<std::int64_t> dominated;                // candidates that --reduce left out
  std::optional<std::int64_t> cliques, clique_members;  // of the cover, if there is one
};

GraphSummary summarize(const BuildgraphResult& result);
std::vector<std::string> warnings_about(const GraphSummary& summary);
std::vector<std::string> summary_lines(const GraphSummary& summary);
nlohmann::ordered_json to_json(const GraphSummary& summary);
nlohmann::ordered_json history_of(const GraphSummary& summary);

}  // namespace hexpipe::buildgraph
