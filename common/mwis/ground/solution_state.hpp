#pragma once
// An independent set that changes, with what every search asks about it: how many chosen neighbours a vertex has
// (tightness), their weight and, if there is only one, which one it is.

#include <cassert>
#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::mwis::ground {

// add and remove are the only two mutators. Each costs O(degree).
class SolutionState {
 public:
  explicit SolutionState(const graph::ConflictGraph& graph);
  SolutionState(const graph::ConflictGraph& graph, const graph::IndependentSet& solution);

  const graph::ConflictGraph& graph() const { return *graph_; }
  bool contains(std::int32_t v) const { return chosen_[v] != 0; }
  std::int32_t tightness(std::int32_t v) const { return around_[v].tightness; }
  // The sum of the numbers of the chosen neighbours, modulo 2^32. It tells the last one when all others are known.
  std::uint32_t neighbour_sum(std::int32_t v) const { return around_[v].number_sum; }
  // The gain of Push(v): v comes in, its chosen neighbours go out.
  std::int64_t push_gain(std::int32_t v) const { return around_[v].push_gain; }
  std::int64_t weight() const { return weight_; }

  // v must be neither chosen nor have a chosen neighbour.
  void add(std::int32_t v);
  // v must be chosen. Calls touched(u) for each neighbour once its values are right again.
  template <class Touched>
  void remove(std::int32_t v, Touched&& touched);
  void remove(std::int32_t v) {
    remove(v, [](std::int32_t) {});
  }

  // Calls visit(u) for the chosen neighbours of v, ascending. The state must not change meanwhile.
  template <class Visit>
  void for_each_chosen_neighbour(std::int32_t v, Visit&& visit) const {
    std::int32_t left = around_[v].tightness;
    if (left == 1) return visit(static_cast<std::int32_t>(around_[v].number_sum));
    for (const std::int32_t* u = graph_->neighbours.data() + graph_->offsets[v]; left > 0; ++u)
      if (chosen_[*u] != 0) {
        --left;
        visit(*u);
      }
  }

  // Adds free vertices, the heaviest first, until none is left. Vertices of weight zero count, too: a set is maximal
  // with them.
  void make_maximal();

  graph::IndependentSet to_set() const;

  // True if all stored values agree with the chosen vertices, and these are independent. O(vertices + edges), for
  // tests.
  bool check() const;

 private:
  struct Around {
    std::int64_t push_gain = 0;
    std::int32_t tightness = 0;
    std::uint32_t number_sum = 0;
    bool operator==(const Around&) const = default;
  };

  const graph::ConflictGraph* graph_;
  std::vector<Around> around_;
  std::vector<std::uint8_t> chosen_;
  std::int64_t weight_ = 0;
};

template <class Touched>
void SolutionState::remove(std::int32_t v, Touched&& touched) {
  assert(contains(v));
  const std::int64_t weight = graph_->weights[v];
  chosen_[v] = 0;
  weight_ -= weight;
  for (const std::int32_t u : graph_->neighbours_of(v)) {
    Around& around = around_[u];
    around.push_gain += weight;
    --around.tightness;
    around.number_sum -= static_cast<std::uint32_t>(v);
    touched(u);
  }
}

}  // namespace hexpipe::mwis::ground
