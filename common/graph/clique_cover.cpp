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
      if (graph_.degree(v) == 0) cover_.add({{v}});
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
    cover_.add(clique_);
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

  const ConflictGraph& graph_;
  CliqueCover cover_;
  std::vector<char> covered_;  // by directed edge
  std::vector<std::int64_t> mark_;
  std::int64_t stamp_ = 0;
  std::vector<std::int32_t> clique_, candidates_;
};

// Maximal cliques, grown from each vertex by the largest fractions first.
class ViolatedCliques {
 public:
  ViolatedCliques(const ConflictGraph& graph, const std::vector<double>& fractions, CliqueCover& cover)
      : graph_(graph), fractions_(fractions), cover_(cover), found_(graph.weights.size(), 0) {}

  std::int64_t add() {
    std::vector<std::int32_t> centres;
    for (std::int32_t v = 0; v < graph_.vertex_count(); ++v)
      if (fractions_[v] >= worth_it) centres.push_back(v);
    sort(centres);
    const std::int64_t before = cover_.size();
    for (const std::int32_t v : centres)
      if (found_[v] < often) grow_from(v);
    return cover_.size() - before;
  }

 private:
  // Smaller fractions start no clique, so that the cliques found differ; nor do vertices that are in so many already.
  static constexpr double worth_it = 0.05;
  static constexpr int often = 2;
  static constexpr double most = 1.02;

  void sort(std::vector<std::int32_t>& vertices) const {
    std::ranges::stable_sort(vertices, std::ranges::greater(), [&](std::int32_t v) { return fractions_[v]; });
  }

  void grow_from(std::int32_t v) {
    const auto neighbours = graph_.neighbours_of(v);
    candidates_.assign(neighbours.begin(), neighbours.end());
    sort(candidates_);
    clique_.assign(1, v);
    double sum = fractions_[v];
    for (const std::int32_t u : candidates_) {
      if (!std::all_of(clique_.begin() + 1, clique_.end(), [&](std::int32_t w) { return graph_.has_edge(u, w); }))
        continue;
      clique_.push_back(u);
      sum += fractions_[u];
    }
    if (sum <= most) return;
    for (const std::int32_t u : clique_) found_[u] += fractions_[u] >= worth_it ? 1 : 0;
    std::ranges::sort(clique_);
    cover_.add(clique_);
  }

  const ConflictGraph& graph_;
  const std::vector<double>& fractions_;
  CliqueCover& cover_;
  std::vector<int> found_;
  std::vector<std::int32_t> candidates_, clique_;
};

}  // namespace

CliqueCover greedy_edge_clique_cover(const ConflictGraph& graph) {
  return CoverBuilder(graph).build();
}

std::int64_t add_violated_cliques(const ConflictGraph& graph, const std::vector<double>& fractions,
                                  CliqueCover& cover) {
  return ViolatedCliques(graph, fractions, cover).add();
}

}  // namespace hexpipe
