#include "tools/buildgraph/buildgraph.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "common/conflicts/quad_vertices.hpp"
#include "common/graph/clique_cover.hpp"
#include "common/run/error.hpp"
#include "tools/buildgraph/neighbours.hpp"
#include "tools/buildgraph/reduce.hpp"

namespace hexpipe::buildgraph {
namespace {

BuildgraphResult reduced_graph(Candidates candidates, const BuildgraphOptions& options, const char* source) {
  BuildgraphResult result{.product = {.graph = conflicts::conflict_graph(candidates, options.conflicts, source)}};
  graph::ConflictGraph& graph = result.product.graph;
  result.dominated = reduce(candidates, graph);
  if (options.cover) result.product.cover = graph::greedy_edge_clique_cover(graph, graph::cliques_of_tets(candidates));
  result.product.candidates = pipeline::CandidatesProduct{.candidates = std::move(candidates)};
  return result;
}

// Without tets, which take half of the memory.
Candidates cells_alone(const Candidates& candidates) {
  return {.vertices = candidates.vertices,
          .kind = candidates.kind,
          .quality = candidates.quality,
          .volume = candidates.volume,
          .tets = {},
          .boundary_tets = {}};
}

void add_quads(const Candidates& cells, const KeySet<3>& boundary, const BuildgraphOptions& options, const char* source,
               pipeline::GraphProduct& product) {
  conflicts::InnerQuads quads = conflicts::find_inner_quads(cells, product.graph, boundary);
  const auto prices = [&](const conflicts::QuadList& list) {
    return conflicts::prices_of(list, cells, options.conflicts, options.quad_reward, source);
  };
  conflicts::add_quad_vertices(quads.shared, prices(quads.shared), product.graph, source);
  conflicts::pay_for_lonely_quads(quads.lonely, prices(quads.lonely), product.graph);
  product.quads = std::move(quads.shared.quads);
}

// `boundary`: of the mesh, for quads.
BuildgraphResult whole_graph(Candidates candidates, const KeySet<3>& boundary, const BuildgraphOptions& options,
                             const char* source) {
  const graph::CliqueCover known = options.cover ? graph::cliques_of_tets(candidates) : graph::CliqueCover();
  const bool has_quads = options.quad_reward > 0;
  const Candidates cells = has_quads ? cells_alone(candidates) : Candidates();
  BuildgraphResult result{
      .product = {.graph = conflicts::conflict_graph(std::move(candidates), options.conflicts, source)}};
  if (has_quads) add_quads(cells, boundary, options, source, result.product);
  if (options.cover) result.product.cover = graph::greedy_edge_clique_cover(result.product.graph, known);
  return result;
}

// `all`: the candidates of a part and those of its neighbours. A neighbour's stays where it is in conflict with one of
// the part's own, and an edge joins at least one of its own.
pipeline::GraphProduct graph_of_part(PartCandidates all, std::int32_t part, const conflicts::ConflictOptions& conflicts,
                                     const char* source) {
  std::vector<bool> own(all.keys.part.size());
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = all.keys.part[i] == part;
  pipeline::GraphProduct product{.graph = conflicts::conflict_graph(all.candidates, conflicts, source, own)};
  graph::ConflictGraph& graph = product.graph;
  std::vector<std::int32_t> kept;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    if (own[v] || graph.degree(v) > 0) kept.push_back(v);
  keep_only(graph, kept);
  keep_only(all.candidates, kept);
  keep_only(all.keys, kept);
  product.candidates =
      pipeline::CandidatesProduct{.candidates = std::move(all.candidates), .keys = std::move(all.keys)};
  return product;
}

pipeline::GraphProduct read_graph_of_part(pipeline::StageData data, const BuildgraphOptions& options,
                                          const std::string& source) {
  if (options.conflicts.share.count > 1 || options.reduce || options.cover || options.quad_reward > 0)
    throw UsageError(fmt::format("--part, --reduce, --cover and --quad-reward need the whole graph, not that of {}",
                                 title_of(*data.part)));
  if (!data.candidate_keys)
    throw DataError::at(source, "expected candidates with their keys, as findhex makes them of a part, found none");
  PartCandidates own{std::move(*data.candidates), std::move(*data.candidate_keys)};
  pipeline::GraphProduct product =
      graph_of_part(with_neighbours(std::move(own), *data.part, data.history, options.neighbours, source),
                    data.part->part, options.conflicts, source.c_str());
  // Without neighbours, the candidates are those of the input, which pass.
  if (options.neighbours.empty()) product.candidates.reset();
  return product;
}

}  // namespace

BuildgraphResult buildgraph(pipeline::StageData data, const BuildgraphOptions& options, const InputNames& names) {
  const std::string& source = names.candidates;
  if (data.part) return {.product = read_graph_of_part(std::move(data), options, source)};
  if (!options.neighbours.empty())
    throw UsageError("--neighbours goes with the candidates of a part of a mesh, as mesh-part makes them");
  if (options.reduce) return reduced_graph(std::move(*data.candidates), options, source.c_str());
  KeySet<3> boundary;
  if (data.mesh && options.quad_reward > 0) boundary = conflicts::boundary_of(*data.mesh, names.mesh.c_str());
  data.mesh.reset();
  return whole_graph(std::move(*data.candidates), boundary, options, source.c_str());
}

}  // namespace hexpipe::buildgraph
