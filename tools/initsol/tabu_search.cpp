#include "tools/initsol/tabu_search.hpp"

#include <algorithm>
#include <numeric>

namespace hexpipe::initsol {

TabuSearch::TabuSearch(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                       const TabuOptions& options, Random random)
    : graph_(graph),
      options_(options),
      random_(random),
      state_(graph),
      open_(graph.weights.size()),
      tabu_(graph.weights.size()),
      tabu_until_(graph.weights.size(), 0),
      moved_(graph.weights.size(), 0) {
  restart_at(start);
  best_weight_ = state_.weight();
  best_is_stored_ = false;
}

void TabuSearch::run(std::int64_t moves, const Deadline& deadline) {
  for (const std::int64_t end = moves_ + moves; moves_ < end && has_move() && !deadline.passed();) {
    end_tabus();
    push(choose());
    ++moves_;
    if (state_.weight() > best_weight_)
      note_best();
    else if (moves_ - last_best_move_ >= options_.patience)
      take_way_out();
  }
}

void TabuSearch::end_tabus() {
  while (!tabu_ends_.empty() && tabu_ends_.front().move <= moves_) {
    const auto [move, v] = tabu_ends_.front();
    std::pop_heap(tabu_ends_.begin(), tabu_ends_.end());
    tabu_ends_.pop_back();
    // The vertex went in by aspiration, or back to the best solution, and perhaps out again for longer.
    if (!tabu_.contains(v) || tabu_until_[v] != move) continue;
    tabu_.erase(v);
    open_.insert(v, state_.push_gain(v));
  }
}

// A vertex that is tabu may move when that gives a new best solution, or when no other one can move.
std::int32_t TabuSearch::choose() const {
  if (open_.empty()) return tabu_.top();
  const bool aspires =
      !tabu_.empty() && tabu_.top_key() > open_.top_key() && state_.weight() + tabu_.top_key() > best_weight_;
  return aspires ? tabu_.top() : open_.top();
}

void TabuSearch::push(std::int32_t v) {
  pushed_out_.clear();
  state_.for_each_chosen_neighbour(v, [&](std::int32_t u) { pushed_out_.push_back(u); });
  for (const std::int32_t u : pushed_out_) remove(u);
  insert(v);
}

void TabuSearch::insert(std::int32_t v) {
  (tabu_.contains(v) ? tabu_ : open_).erase(v);
  state_.add(v);
  ++moved_[v];
  since_best_.push_back(v);
  update_gains_around(v);
}

void TabuSearch::remove(std::int32_t v) {
  state_.remove(v);
  ++moved_[v];
  since_best_.push_back(v);
  update_gains_around(v);
  const auto tenure = static_cast<std::uint64_t>(options_.tenure);
  const auto end = moves_ + 1 + options_.tenure + static_cast<std::int64_t>(tenure == 0 ? 0 : random_.below(tenure));
  tabu_.insert(v, state_.push_gain(v));
  tabu_ends_.push_back({end, v});
  tabu_until_[v] = end;
  std::push_heap(tabu_ends_.begin(), tabu_ends_.end());
}

void TabuSearch::update_gains_around(std::int32_t v) {
  for (const std::int32_t u : graph_.neighbours_of(v)) {
    if (open_.contains(u))
      open_.update(u, state_.push_gain(u));
    else if (tabu_.contains(u))
      tabu_.update(u, state_.push_gain(u));
  }
}

void TabuSearch::note_best() {
  best_weight_ = state_.weight();
  last_best_move_ = moves_;
  since_best_.clear();
  best_is_stored_ = false;
}

void TabuSearch::take_way_out() {
  last_best_move_ = moves_;
  if (options_.escape == Escape::best) return return_to_best();
  best_ = best();
  best_is_stored_ = true;
  std::vector<std::int32_t> order(graph_.weights.size());
  std::iota(order.begin(), order.end(), 0);
  random_.shuffle(std::span(order));
  if (options_.escape == Escape::rebuild)
    std::ranges::stable_sort(order, {}, [&](std::int32_t v) { return moved_[v]; });
  restart_at(build_in_order(order));
  if (state_.weight() > best_weight_) note_best();
}

// Undoes the moves since then, so that the cost depends on their number and not on the size of the graph.
void TabuSearch::return_to_best() {
  const std::vector<std::int32_t> undo(since_best_.rbegin(), since_best_.rend());
  for (const std::int32_t v : undo) {
    if (state_.contains(v))
      remove(v);
    else
      insert(v);
  }
  since_best_.clear();
}

void TabuSearch::restart_at(const graph::IndependentSet& solution) {
  state_ = mwis::ground::SolutionState(graph_, solution);
  state_.make_maximal();
  open_.clear();
  tabu_.clear();
  tabu_ends_.clear();
  std::ranges::fill(tabu_until_, 0);
  since_best_.clear();
  for (std::int32_t v = 0; v < graph_.vertex_count(); ++v)
    if (!state_.contains(v)) open_.insert(v, state_.push_gain(v));
}

graph::IndependentSet TabuSearch::build_in_order(const std::vector<std::int32_t>& order) const {
  mwis::ground::SolutionState fresh(graph_);
  for (const std::int32_t v : order)
    if (fresh.tightness(v) == 0) fresh.add(v);
  return fresh.to_set();
}

graph::IndependentSet TabuSearch::best() const {
  if (best_is_stored_) return best_;
  std::vector<char> chosen(graph_.weights.size());
  for (std::int32_t v = 0; v < graph_.vertex_count(); ++v) chosen[v] = state_.contains(v);
  for (const std::int32_t v : since_best_) chosen[v] = !chosen[v];
  graph::IndependentSet solution;
  for (std::int32_t v = 0; v < graph_.vertex_count(); ++v)
    if (chosen[v]) solution.push_back(v);
  return solution;
}

bool TabuSearch::check() const {
  if (!state_.check() || !open_.check() || !tabu_.check()) return false;
  for (std::int32_t v = 0; v < graph_.vertex_count(); ++v)
    if (state_.contains(v) == (open_.contains(v) || tabu_.contains(v)) ||
        (open_.contains(v) && tabu_until_[v] > moves_))
      return false;
  return true;
}

}  // namespace hexpipe::initsol
