#include "common/mwis/exact/heavy_cliques.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::mwis::exact {
namespace {

// A simplex may return a little more than this for 0.
constexpr double nothing = 1e-6;
// The fractions of a clique have to exceed 1 by this much. Smaller excess moves the bound less than it costs the
// simplex.
constexpr double least_excess = 0.01;
// A vertex may be in this many cliques per call; more of them are nearly the same.
constexpr int most_of_a_vertex = 2;
// For branch and bound around a vertex, where some tens of vertices are fractional.
constexpr std::int64_t most_nodes = 300;
// Fractions become whole weights by this factor.
constexpr double unit = 1e6;

std::int64_t whole(double fraction) {
  return std::llround(unit * fraction);
}

}  // namespace

std::int64_t HeavyCliques::add(const std::vector<double>& fractions, graph::CliqueCover& cover) {
  fractions_ = &fractions;
  std::vector<std::int32_t> support;
  for (std::int32_t v = 0; v < graph_.vertex_count(); ++v) {
    found_[v] = 0;
    in_support_[v] = fractions[v] > nothing ? 1 : 0;
    if (in_support_[v] != 0 && fractions[v] < 1 - nothing) support.push_back(v);
  }
  std::ranges::stable_sort(support, std::ranges::greater(), [&](std::int32_t v) { return fractions[v]; });
  const std::int64_t before = cover.size();
  for (const std::int32_t v : support) {
    if (found_[v] >= most_of_a_vertex || !find_around(v)) continue;
    for (const std::int32_t u : clique_) ++found_[u];
    make_maximal();
    cover.add(clique_);
  }
  return cover.size() - before;
}

// Leaves in clique_ the heaviest clique of fractional vertices around v. False if it is not heavy enough.
bool HeavyCliques::find_around(std::int32_t v) {
  around_.clear();
  for (const std::int32_t u : graph_.neighbours_of(v))
    if (in_support_[u] != 0) around_.push_back(u);
  make_complement();
  ground::SearchBudget budget(most_nodes);
  if (!branch_and_bound_.solve(complement_, whole(1 + least_excess - (*fractions_)[v]), budget)) return false;
  clique_.assign(1, v);
  for (const std::uint32_t i : branch_and_bound_.best()) clique_.push_back(around_[i]);
  return true;
}

void HeavyCliques::make_complement() {
  complement_.reset(around_.size());
  for (std::size_t i = 0; i < around_.size(); ++i) {
    complement_.set_weight(i, whole((*fractions_)[around_[i]]));
    for (std::size_t j = 0; j < i; ++j)
      if (!graph_.has_edge(around_[i], around_[j])) complement_.add_edge(i, j);
  }
}

// Adds what can be added, the heaviest first.
void HeavyCliques::make_maximal() {
  const std::int32_t first = clique_.front();
  const auto neighbours = graph_.neighbours_of(first);
  around_.assign(neighbours.begin(), neighbours.end());
  std::ranges::stable_sort(around_, std::ranges::greater(), [&](std::int32_t v) { return graph_.weights[v]; });
  for (const std::int32_t v : around_)
    if (std::ranges::all_of(clique_, [&](std::int32_t u) { return u != v && graph_.has_edge(u, v); }))
      clique_.push_back(v);
  std::ranges::sort(clique_);
}

}  // namespace hexpipe::mwis::exact
