// The search compares neighbourhoods of conflicting candidates only where the lighter one has no fewer conflicts, and
// ends a comparison at the first neighbour that tells them apart. After the first round, only vertices that have lost a
// neighbour can dominate others anew.

#include "tools/buildgraph/reduce.hpp"

#include <algorithm>
#include <utility>

namespace hexpipe::buildgraph {
namespace {

class Domination {
 public:
  explicit Domination(const graph::ConflictGraph& graph)
      : graph_(graph),
        degrees_(graph.weights.size()),
        mark_(graph.weights.size(), no_index),
        gone_(graph.weights.size(), 0),
        changed_(graph.weights.size(), 1) {
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) degrees_[v] = graph.degree(v);
  }

  std::vector<std::int32_t> run() {
    for (bool again = true; again;) again = run_round();
    std::vector<std::int32_t> stay;
    for (std::int32_t v = 0; v < graph_.vertex_count(); ++v)
      if (gone_[v] == 0) stay.push_back(v);
    return stay;
  }

 private:
  // Whether a vertex was left out.
  bool run_round() {
    std::vector<char> changed_now(graph_.weights.size(), 0);
    bool any = false;
    for (std::int32_t v = 0; v < graph_.vertex_count(); ++v) {
      if (gone_[v] != 0 || !is_dominated(v)) continue;
      any = true;
      gone_[v] = 1;
      for (const std::int32_t u : graph_.neighbours_of(v)) {
        --degrees_[u];
        changed_[u] = changed_now[u] = 1;
      }
    }
    changed_ = std::move(changed_now);
    return any;
  }

  bool is_dominated(std::int32_t v) {
    const auto neighbours = graph_.neighbours_of(v);
    bool marked = false;
    for (const std::int32_t u : neighbours) {
      if (gone_[u] != 0 || changed_[u] == 0 || graph_.weights[u] < graph_.weights[v] || degrees_[u] > degrees_[v])
        continue;
      if (!marked) {
        for (const std::int32_t n : neighbours) mark_[n] = v;
        mark_[v] = v;
        marked = true;
      }
      const auto others = graph_.neighbours_of(u);
      if (std::ranges::all_of(others, [&](std::int32_t n) { return mark_[n] == v || gone_[n] != 0; })) return true;
    }
    return false;
  }

  const graph::ConflictGraph& graph_;
  std::vector<std::int64_t> degrees_;  // among the vertices that are left
  std::vector<std::int32_t> mark_;     // the last vertex that this one was seen beside
  std::vector<char> gone_;
  std::vector<char> changed_;  // has lost a neighbour since the last round began
};

}  // namespace

std::vector<std::int32_t> undominated_vertices(const graph::ConflictGraph& graph) {
  return Domination(graph).run();
}

}  // namespace hexpipe::buildgraph
