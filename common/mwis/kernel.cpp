#include "common/mwis/kernel.hpp"

#include <algorithm>
#include <deque>
#include <numeric>

#include "common/mwis/clique_cover_bound.hpp"
#include "common/mwis/solution_state.hpp"

namespace hexpipe {

// The graph while it shrinks. Every vertex is looked at as the centre of its neighbourhood, from the lowest degree on,
// and again when something around it changed.
class Reducer {
 public:
  Reducer(const ConflictGraph& graph, Kernel& kernel)
      : graph_(graph),
        kernel_(kernel),
        weights_(graph.weights),
        neighbours_(graph.neighbours),
        ends_(graph.offsets.begin() + 1, graph.offsets.end()),
        sums_(graph.weights.size(), 0),
        stale_(graph.weights.size(), 0),
        alive_(graph.weights.size(), 1),
        waiting_(graph.weights.size(), 1),
        places_(graph.weights.size(), nowhere),
        left_(graph.vertex_count()) {
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
      for (const std::int32_t u : graph.neighbours_of(v)) sums_[v] += weights_[u];
    std::vector<std::int32_t> order(graph.weights.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::int32_t v) { return graph.degree(v); });
    queue_.assign(order.begin(), order.end());
  }

  void run(const Deadline& deadline) {
    std::int32_t left_before = left_;
    std::size_t seen = 0;
    while (!queue_.empty()) {
      const std::int32_t v = queue_.front();
      queue_.pop_front();
      waiting_[v] = 0;
      if (alive_[v]) decide(v);
      if (++seen % 64 == 0 && deadline.passed()) break;
      if (seen % window != 0) continue;
      if (left_before - left_ < least_yield) break;
      left_before = left_;
    }
    build_kernel();
  }

 private:
  static constexpr std::int32_t nowhere = -1;
  // Neighbourhoods are looked into up to this size; beyond it the cost (its square) exceeds what hubs ever gave.
  static constexpr std::size_t largest_neighbourhood = 512;
  // Reductions end when of so many centres fewer than so many vertices were decided. On conflict graphs of meshes,
  // where low degrees come first, that keeps what decides 3 % of the vertices and leaves out two thirds of the time.
  static constexpr std::size_t window = 1024;
  static constexpr std::int32_t least_yield = 16;

  void decide(std::int32_t v) {
    if (weights_[v] == 0) return drop(v);
    if (sums_[v] <= weights_[v]) return take(v);
    refresh(v);
    around_.assign(begin_of(v), end_of(v));
    if (around_.size() > largest_neighbourhood) return;
    build_local();
    if (bound_without(nullptr, weights_[v])) return take(v);
    if (is_clique()) return transfer_weight(v);
    drop_replaceable(v);
    if (alive_count_ == around_.size()) drop_common(v);
  }

  // The neighbourhood as a small graph.
  void build_local() {
    local_.reset(around_.size());
    set_.assign(local_.words(), 0);
    alive_count_ = around_.size();
    for (std::size_t i = 0; i < around_.size(); ++i) places_[around_[i]] = static_cast<std::int32_t>(i);
    for (std::size_t i = 0; i < around_.size(); ++i) {
      local_.set_weight(i, weights_[around_[i]]);
      bits::Word* const row = local_.row(i);
      for (const std::int32_t* u = begin_of(around_[i]); u != end_of(around_[i]); ++u)
        if (places_[*u] != nowhere) bits::insert(row, static_cast<std::size_t>(places_[*u]));
    }
    for (const std::int32_t u : around_) places_[u] = nowhere;
  }

  // No independent set of neighbours, without those in `excluded`, outweighs `limit`.
  bool bound_without(const bits::Word* excluded, std::int64_t limit) {
    bits::fill(set_.data(), around_.size());
    if (excluded != nullptr)
      for (std::size_t w = 0; w < set_.size(); ++w) set_[w] &= ~excluded[w];
    return bound_.at_most(local_, set_.data(), limit);
  }

  bool is_clique() const {
    for (std::size_t i = 0; i < around_.size(); ++i)
      if (bits::count(local_.row(i), local_.words()) + 1 != around_.size()) return false;
    return true;
  }

  // The neighbours are a clique and some are heavier: v is chosen unless one of them is, which then brings only the
  // difference.
  void transfer_weight(std::int32_t v) {
    const std::int64_t weight = weights_[v];
    kernel_.offset_ += weight;
    kernel_.decisions_.push_back({Kernel::Step::take_if_free, v});
    remove(v);
    const std::vector<std::int32_t> neighbours = around_;
    for (const std::int32_t u : neighbours) {
      if (weights_[u] <= weight)
        drop(u);
      else
        lighten(u, weight);
    }
  }

  // Basic single edge, with domination as a special case: a neighbour whose place v can take together with that of all
  // that v pushes out beside it.
  void drop_replaceable(std::int32_t v) {
    excluded_.resize(local_.words());
    for (std::size_t i = 0; i < around_.size(); ++i) {
      const std::int64_t allowance = weights_[v] - weights_[around_[i]];
      if (allowance < 0) continue;
      std::copy_n(local_.row(i), local_.words(), excluded_.data());
      for (std::size_t j = 0; j < around_.size(); ++j)
        if (!alive_[around_[j]]) bits::insert(excluded_.data(), j);
      bits::insert(excluded_.data(), i);
      if (!bound_without(excluded_.data(), allowance)) continue;
      drop(around_[i]);
      --alive_count_;
    }
  }

  // Extended single edge: when v outweighs its neighbourhood without u, one of the two is chosen, and no common
  // neighbour.
  void drop_common(std::int32_t v) {
    for (std::size_t i = 0; i < around_.size(); ++i) {
      excluded_.assign(local_.words(), 0);
      bits::insert(excluded_.data(), i);
      if (bits::empty(local_.row(i), local_.words()) || !bound_without(excluded_.data(), weights_[v])) continue;
      bits::for_each(local_.row(i), local_.words(), [&](std::size_t common) { drop(around_[common]); });
      wait(v);
      return;
    }
  }

  void take(std::int32_t v) {
    kernel_.offset_ += weights_[v];
    kernel_.decisions_.push_back({Kernel::Step::take, v});
    refresh(v);
    const std::vector<std::int32_t> neighbours(begin_of(v), end_of(v));
    remove(v);
    for (const std::int32_t u : neighbours) drop(u);
  }

  void drop(std::int32_t v) {
    remove(v);
    for (const std::int32_t* u = begin_of(v); u != end_of(v); ++u)
      if (alive_[*u]) wait(*u);
  }

  void remove(std::int32_t v) {
    alive_[v] = 0;
    --left_;
    for (const std::int32_t* u = begin_of(v); u != end_of(v); ++u) {
      sums_[*u] -= weights_[v];
      stale_[*u] = 1;
    }
  }

  void lighten(std::int32_t v, std::int64_t weight) {
    weights_[v] -= weight;
    wait(v);
    for (const std::int32_t* u = begin_of(v); u != end_of(v); ++u) {
      sums_[*u] -= weight;
      if (alive_[*u]) wait(*u);
    }
  }

  void wait(std::int32_t v) {
    if (waiting_[v]) return;
    waiting_[v] = 1;
    queue_.push_back(v);
  }

  // Takes removed vertices out of the neighbours of v.
  void refresh(std::int32_t v) {
    if (!stale_[v]) return;
    stale_[v] = 0;
    const auto first = neighbours_.begin() + graph_.offsets[v];
    const auto last = std::remove_if(first, neighbours_.begin() + ends_[v], [&](std::int32_t u) { return !alive_[u]; });
    ends_[v] = last - neighbours_.begin();
  }

  const std::int32_t* begin_of(std::int32_t v) const { return neighbours_.data() + graph_.offsets[v]; }
  const std::int32_t* end_of(std::int32_t v) const { return neighbours_.data() + ends_[v]; }

  void build_kernel() {
    std::vector<std::int32_t> numbers(weights_.size(), nowhere);
    for (std::int32_t v = 0; v < graph_.vertex_count(); ++v) {
      if (!alive_[v]) continue;
      numbers[v] = static_cast<std::int32_t>(kernel_.vertices_.size());
      kernel_.vertices_.push_back(v);
    }
    for (const std::int32_t v : kernel_.vertices_) {
      refresh(v);
      for (const std::int32_t* u = begin_of(v); u != end_of(v); ++u) kernel_.kernel_.neighbours.push_back(numbers[*u]);
      kernel_.kernel_.offsets.push_back(static_cast<std::int64_t>(kernel_.kernel_.neighbours.size()));
      kernel_.kernel_.weights.push_back(weights_[v]);
    }
  }

  const ConflictGraph& graph_;
  Kernel& kernel_;
  std::vector<std::int64_t> weights_;
  std::vector<std::int32_t> neighbours_;  // as in the graph, shortened to what is left
  std::vector<std::int64_t> ends_;
  std::vector<std::int64_t> sums_;  // weights of the neighbours left
  std::vector<char> stale_, alive_, waiting_;
  std::vector<std::int32_t> places_;  // in around_, while local_ is built
  std::deque<std::int32_t> queue_;
  std::int32_t left_;

  // The neighbourhood of the centre that is looked at.
  std::vector<std::int32_t> around_;
  DenseGraph local_;
  std::vector<bits::Word> set_, excluded_;
  std::size_t alive_count_ = 0;
  CliqueCoverBound bound_;
};

Kernel::Kernel(const ConflictGraph& graph, const Deadline& deadline) : original_(graph) {
  Reducer(graph, *this).run(deadline);
}

IndependentSet Kernel::lift(const IndependentSet& of_kernel) const {
  SolutionState state(original_);
  for (const std::int32_t v : of_kernel) state.add(vertices_[v]);
  for (auto decision = decisions_.rbegin(); decision != decisions_.rend(); ++decision)
    if (decision->step == Step::take || state.tightness(decision->vertex) == 0) state.add(decision->vertex);
  state.make_maximal();
  return state.to_set();
}

IndependentSet Kernel::project(const IndependentSet& of_graph) const {
  IndependentSet of_kernel;
  for (std::int32_t v = 0; v < kernel_.vertex_count(); ++v)
    if (std::ranges::binary_search(of_graph, vertices_[v])) of_kernel.push_back(v);
  return of_kernel;
}

}  // namespace hexpipe
