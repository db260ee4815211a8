#include <algorithm>
#include <span>
#include <vector>

#include "common/graph/clique_cover.hpp"

namespace hexpipe::graph {

void add_cliques_at_last(const ConflictGraph& graph, std::int32_t first, CliqueCover& cover) {
  std::vector<std::int32_t> left, others, clique;
  for (std::int32_t v = first; v < graph.vertex_count(); ++v) {
    const auto neighbours = graph.neighbours_of(v);
    left.assign(neighbours.begin(), neighbours.end());
    while (!left.empty()) {
      clique.clear();
      others.clear();
      for (const std::int32_t u : left) {
        const bool joins = std::ranges::all_of(clique, [&](std::int32_t w) { return graph.has_edge(u, w); });
        (joins ? clique : others).push_back(u);
      }
      clique.push_back(v);
      cover.add(clique);
      std::swap(left, others);
    }
  }
}

}  // namespace hexpipe::graph
