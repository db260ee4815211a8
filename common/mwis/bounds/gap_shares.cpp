#include "common/mwis/bounds/gap_shares.hpp"

#include <algorithm>
#include <numeric>

namespace hexpipe::mwis::bounds {
namespace {

// On block-28k and sphere-56k, after initsol, 12 % and 7 % of the solution hold this share.
constexpr double most_of_gap = 0.8;

class GapDivider {
 public:
  GapDivider(const graph::ConflictGraph& graph, const graph::IndependentSet& solution)
      : graph_(graph), places_(graph.weights.size(), no_index), shares_(solution.size(), 0) {
    for (std::size_t i = 0; i < solution.size(); ++i) places_[solution[i]] = static_cast<std::int32_t>(i);
  }

  bool is_chosen(std::int32_t v) const { return places_[v] != no_index; }
  void charge(std::int32_t chosen, std::int64_t amount) { shares_[places_[chosen]] += amount; }

  // Divides an amount equally among the chosen neighbours of these vertices; the first ones get the rest of the
  // division.
  void divide(std::span<const std::int32_t> vertices, std::int64_t amount) {
    near_.clear();
    for (const std::int32_t v : vertices)
      for (const std::int32_t w : graph_.neighbours_of(v))
        if (is_chosen(w)) near_.push_back(w);
    std::sort(near_.begin(), near_.end());
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
    const auto count = std::ssize(near_);
    for (std::int64_t i = 0; i < count; ++i) charge(near_[i], amount / count + (i < amount % count ? 1 : 0));
  }

  std::vector<std::int64_t> take() { return std::move(shares_); }

 private:
  const graph::ConflictGraph& graph_;
  std::vector<std::int32_t> places_;  // by vertex: its place in the solution
  std::vector<std::int64_t> shares_;
  std::vector<std::int32_t> near_;
};

}  // namespace

std::vector<std::int64_t> gap_shares(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                                     const std::vector<std::int64_t>& prices, const graph::IndependentSet& solution) {
  GapDivider divider(graph, solution);
  for (std::int64_t c = 0; c < cover.size(); ++c) {
    const auto clique = cover.clique(c);
    if (prices[c] > 0 && std::none_of(clique.begin(), clique.end(), [&](auto v) { return divider.is_chosen(v); }))
      divider.divide(clique, prices[c]);
  }
  const std::vector<std::int64_t> costs = reduced_costs(graph, cover, prices);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    if (divider.is_chosen(v) && costs[v] < 0) divider.charge(v, -costs[v]);
    if (!divider.is_chosen(v) && costs[v] > 0) divider.divide(std::span(&v, 1), costs[v]);
  }
  return divider.take();
}

std::vector<bool> holds_most_of_gap(std::int32_t vertex_count, const graph::IndependentSet& solution,
                                    std::span<const std::int64_t> shares) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  double left = 0;
  for (const std::int64_t share : shares) left += static_cast<double>(share);
  const double enough = (1 - most_of_gap) * left;
  std::vector<bool> holds(static_cast<std::size_t>(vertex_count), false);
  for (const std::size_t i : order) {
    if (left <= enough || shares[i] == 0) break;
    holds[solution[i]] = true;
    left -= static_cast<double>(shares[i]);
  }
  return holds;
}

}  // namespace hexpipe::mwis::bounds
