#include "common/graph/clique_cover.hpp"

#include <algorithm>

namespace hexpipe {
namespace {

class CoverBuilder {
 public:
  explicit CoverBuilder(const ConflictGraph& graph)
      : graph_(graph), covered_(graph.neighbours.size(), 0), mark_(graph.weights.size(), 0) {}

  CliqueCover build() {
    for (std::int32_t v = 0; v < graph_.vertex_count(); ++v) {
      if (graph_.degree(v) == 0) add({v});
      for (std::int64_t edge = graph_.offsets[v]; edge < graph_.offsets[v + 1]; ++edge)
        if (!covered_[edge]) grow_from(v, edge);
    }
    return std::move(cover_);
  }

 private:
  // Candidates are common neighbours of the clique so far, those whose edge to v is not covered before the others.
  void grow_from(std::int32_t v, std::int64_t edge) {
    clique_ = {v, graph_.neighbours[edge]};
    candidates_.clear();
    for (const bool covered : {false, true})
      for (std::int64_t e = graph_.offsets[v]; e < graph_.offsets[v + 1]; ++e)
        if ((covered_[e] != 0) == covered && e != edge) candidates_.push_back(graph_.neighbours[e]);
    keep_neighbours_of(clique_.back());
    while (!candidates_.empty()) {
      clique_.push_back(candidates_.front());
      keep_neighbours_of(clique_.back());
    }
    std::ranges::sort(clique_);
    cover_edges();
    add(clique_);
  }

  void keep_neighbours_of(std::int32_t v) {
    ++stamp_;
    for (const std::int32_t u : graph_.neighbours_of(v)) mark_[u] = stamp_;
    std::erase_if(candidates_, [&](std::int32_t u) { return mark_[u] != stamp_; });
  }

  // Both lists ascend, so the members are found in one walk over the neighbours of each.
  void cover_edges() {
    for (const std::int32_t v : clique_) {
      auto from = graph_.neighbours.begin() + graph_.offsets[v];
      const auto end = graph_.neighbours.begin() + graph_.offsets[v + 1];
      for (const std::int32_t u : clique_) {
        if (u == v) continue;
        from = std::lower_bound(from, end, u);
        covered_[from - graph_.neighbours.begin()] = 1;
      }
    }
  }

  void add(const std::vector<std::int32_t>& clique) {
    cover_.members.insert(cover_.members.end(), clique.begin(), clique.end());
    cover_.offsets.push_back(static_cast<std::int64_t>(cover_.members.size()));
  }

  const ConflictGraph& graph_;
  CliqueCover cover_;
  std::vector<char> covered_;  // by directed edge
  std::vector<std::int64_t> mark_;
  std::int64_t stamp_ = 0;
  std::vector<std::int32_t> clique_, candidates_;
};

}  // namespace

CliqueCover greedy_edge_clique_cover(const ConflictGraph& graph) {
  return CoverBuilder(graph).build();
}

}  // namespace hexpipe
