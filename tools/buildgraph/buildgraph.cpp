#include "tools/buildgraph/buildgraph.hpp"

#include <utility>
#include <vector>

#include "common/graph/tet_cliques.hpp"
#include "tools/buildgraph/reduce.hpp"

namespace hexpipe::buildgraph {

BuildgraphResult buildgraph(Candidates candidates, const BuildgraphOptions& options, const char* source) {
  BuildgraphResult result;
  if (options.reduce) {
    result.graph = conflicts::conflict_graph(candidates, options.conflicts, source);
    result.dominated = reduce(candidates, result.graph);
    if (options.cover) result.cover = graph::greedy_edge_clique_cover(result.graph, graph::cliques_of_tets(candidates));
    result.candidates = std::move(candidates);
  } else {
    const graph::CliqueCover known = options.cover ? graph::cliques_of_tets(candidates) : graph::CliqueCover();
    result.graph = conflicts::conflict_graph(std::move(candidates), options.conflicts, source);
    if (options.cover) result.cover = graph::greedy_edge_clique_cover(result.graph, known);
  }
  return result;
}

PartGraph buildgraph_of_part(PartCandidates all, std::int32_t part, const BuildgraphOptions& options,
                             const char* source) {
  std::vector<bool> own(all.keys.part.size());
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = all.keys.part[i] == part;
  PartGraph built;
  graph::ConflictGraph& graph = built.result.graph;
  graph = conflicts::conflict_graph(all.candidates, options.conflicts, source, own);
  std::vector<std::int32_t> kept;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    if (own[v] || graph.degree(v) > 0) kept.push_back(v);
  keep_only(graph, kept);
  keep_only(all.candidates, kept);
  keep_only(all.keys, kept);
  built.candidates = std::move(all);
  return built;
}

}  // namespace hexpipe::buildgraph
