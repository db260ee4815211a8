#include "common/mwis/ground/dense_graph.hpp"

namespace hexpipe::mwis::ground {

DenseGraph dense_graph_of(const graph::ConflictGraph& graph) {
  DenseGraph dense(graph.weights.size());
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    dense.set_weight(v, graph.weights[v]);
    for (const std::int32_t u : graph.neighbours_of(v)) bits::insert(dense.row(v), static_cast<std::size_t>(u));
  }
  return dense;
}

}  // namespace hexpipe::mwis::ground
