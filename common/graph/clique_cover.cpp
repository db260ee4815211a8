#include "common/graph/clique_cover.hpp"

#include <algorithm>
#include <numeric>

#include "common/run/error.hpp"

namespace hexpipe::graph {
namespace {

class CoverBuilder {
 public:
  explicit CoverBuilder(const ConflictGraph& graph)
      : graph_(graph), covered_(graph.neighbours.size(), false), mark_(graph.weights.size(), 0) {}

  // Grows each of the given cliques. Those that are no cliques of the graph are left out.
  void grow(const CliqueCover& cliques) {
    for (std::int64_t c = 0; c < cliques.size(); ++c) {
      clique_.assign(cliques.clique(c).begin(), cliques.clique(c).end());
      bool is_clique = true, is_covered = true;
      for_each_pair([&](bool is_edge, std::int64_t edge) {
        is_clique = is_clique && is_edge;
        is_covered = is_covered && is_edge && covered_[edge];
      });
      if (is_clique && !is_covered) add_grown();
    }
  }

  void complete() {
    for (std::int32_t v = 0; v < graph_.vertex_count(); ++v) {
      if (graph_.degree(v) == 0) cover_.add({v});
      for (std::int64_t edge = graph_.offsets[v]; edge < graph_.offsets[v + 1]; ++edge) {
        if (covered_[edge]) continue;
        clique_ = {v, graph_.neighbours[edge]};
        add_grown();
      }
    }
  }

  CliqueCover take() { return std::move(cover_); }

 private:
  // Calls visit(whether it is an edge, its place among the neighbours) for all pairs of the ascending clique, in both
  // directions. Both lists ascend, so one walk over the neighbours of each member finds the others.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (const std::int32_t v : clique_) {
      auto from = graph_.neighbours.begin() + graph_.offsets[v];
      const auto end = graph_.neighbours.begin() + graph_.offsets[v + 1];
      for (const std::int32_t u : clique_) {
        if (u == v) continue;
        from = std::lower_bound(from, end, u);
        visit(from != end && *from == u, from - graph_.neighbours.begin());
      }
    }
  }

  // Grows the clique until it is maximal, and adds it. It grows by common neighbours of its members. First come those
  // whose edge to the member of least degree is not covered yet.
  void add_grown() {
    std::iter_swap(clique_.begin(),
                   std::ranges::min_element(clique_, {}, [&](std::int32_t v) { return graph_.degree(v); }));
    ++stamp_;
    for (const std::int32_t v : clique_) mark_[v] = stamp_;
    const std::int32_t centre = clique_.front();
    candidates_.clear();
    for (const bool covered : {false, true})
      for (std::int64_t e = graph_.offsets[centre]; e < graph_.offsets[centre + 1]; ++e)
        if (covered_[e] == covered && mark_[graph_.neighbours[e]] != stamp_)
          candidates_.push_back(graph_.neighbours[e]);
    for (std::size_t i = 1; i < clique_.size() && !candidates_.empty(); ++i) keep_neighbours_of(clique_[i]);
    while (!candidates_.empty()) {
      clique_.push_back(candidates_.front());
      keep_neighbours_of(clique_.back());
    }
    std::ranges::sort(clique_);
    for_each_pair([&](bool, std::int64_t edge) { covered_[edge] = true; });
    cover_.add(clique_);
  }

  void keep_neighbours_of(std::int32_t v) {
    // Searching for a few takes less time than marking all neighbours.
    constexpr std::int64_t steps_a_search = 10;
    if (steps_a_search * static_cast<std::int64_t>(candidates_.size()) < graph_.degree(v)) {
      const auto neighbours = graph_.neighbours_of(v);
      std::erase_if(candidates_, [&](std::int32_t u) { return !std::ranges::binary_search(neighbours, u); });
      return;
    }
    ++stamp_;
    for (const std::int32_t u : graph_.neighbours_of(v)) mark_[u] = stamp_;
    std::erase_if(candidates_, [&](std::int32_t u) { return mark_[u] != stamp_; });
  }

  const ConflictGraph& graph_;
  CliqueCover cover_;
  std::vector<bool> covered_;  // by directed edge
  std::vector<std::int64_t> mark_;
  std::int64_t stamp_ = 0;
  std::vector<std::int32_t> clique_, candidates_;
};

// Finds maximal cliques; each is grown from a vertex by adding the largest fractions first.
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
  // Vertices with smaller fractions start no clique, so that the cliques found differ. Vertices that are already in
  // many cliques start none either.
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

void check_cliques(const CliqueCover& cover, std::int32_t vertices, const char* source) {
  if (cover.offsets.empty() || cover.offsets.front() != 0 || !std::ranges::is_sorted(cover.offsets) ||
      cover.offsets.back() != static_cast<std::int64_t>(cover.members.size()))
    throw DataError::at(source, "expected offsets of cliques that ascend from 0 to {}", cover.members.size());
  for (std::int64_t c = 0; c < cover.size(); ++c) {
    std::int32_t last = -1;
    for (const std::int32_t v : cover.clique(c)) {
      if (v <= last || v >= vertices)
        throw DataError::at(source, "expected ascending vertices below {} in clique {}, found {} after {}", vertices, c,
                            v, last);
      last = v;
    }
  }
}

struct CliquesOfVertices {
  std::vector<std::int64_t> offsets, cliques;
};

CliquesOfVertices cliques_of_vertices(const CliqueCover& cover, std::size_t vertices) {
  CliquesOfVertices of;
  of.offsets.assign(vertices + 1, 0);
  for (const std::int32_t v : cover.members) ++of.offsets[v + 1];
  std::partial_sum(of.offsets.begin(), of.offsets.end(), of.offsets.begin());
  of.cliques.resize(cover.members.size());
  std::vector<std::int64_t> next(of.offsets.begin(), of.offsets.end() - 1);
  for (std::int64_t c = 0; c < cover.size(); ++c)
    for (const std::int32_t v : cover.clique(c)) of.cliques[next[v]++] = c;
  return of;
}

}  // namespace

CliqueCover greedy_edge_clique_cover(const ConflictGraph& graph, const CliqueCover& first) {
  CoverBuilder builder(graph);
  builder.grow(first);
  builder.complete();
  return builder.take();
}

CliqueCover maximal_cliques(const ConflictGraph& graph, const CliqueCover& cliques) {
  CoverBuilder builder(graph);
  builder.grow(cliques);
  return builder.take();
}

void validate(const CliqueCover& cover, const ConflictGraph& graph, const char* source) {
  check_cliques(cover, graph.vertex_count(), source);
  const auto [offsets, cliques] = cliques_of_vertices(cover, graph.weights.size());
  // For each vertex, the vertex at which it was last seen: as a neighbour (`beside`) and in a clique (`together`).
  std::vector<std::int32_t> beside(graph.weights.size(), no_index), together(graph.weights.size(), no_index);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    for (const std::int32_t u : graph.neighbours_of(v)) beside[u] = v;
    std::int64_t found = 0;
    for (std::int64_t at = offsets[v]; at < offsets[v + 1]; ++at)
      for (const std::int32_t u : cover.clique(cliques[at])) {
        if (u != v && beside[u] != v)
          throw DataError::at(source, "expected cliques, found {} and {} together, which are no edge", v, u);
        found += u != v && together[u] != v ? 1 : 0;
        together[u] = v;
      }
    if (found != graph.degree(v))
      throw DataError::at(source, "expected every edge in a clique, found {} of {} at vertex {}", found,
                          graph.degree(v), v);
  }
}

std::int64_t add_violated_cliques(const ConflictGraph& graph, const std::vector<double>& fractions,
                                  CliqueCover& cover) {
  return ViolatedCliques(graph, fractions, cover).add();
}

}  // namespace hexpipe::graph
