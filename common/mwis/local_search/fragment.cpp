#include "common/mwis/local_search/fragment.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe::mwis::local_search {

void Fragment::clear() {
  released.clear();
  vertices.clear();
  frontier.clear();
  whole_component = is_cut_off = false;
}

FragmentGrower::FragmentGrower(const ground::SolutionState& state, Random random)
    : state_(state), random_(random), marks_(static_cast<std::size_t>(state.graph().vertex_count())) {}

void FragmentGrower::let_go() {
  // Stamps are never reused. Before they run out (after 2 billion fragments), all marks are reset.
  if (stamp_ > std::numeric_limits<std::uint32_t>::max() / 2) {
    std::ranges::fill(marks_, Mark{});
    stamp_ = 0;
  }
  held_.clear();
  oldest_held_ = stamp_ + 1;
}

void FragmentGrower::let_go(const Fragment& fragment) {
  held_[fragment.stamp - oldest_held_] = 0;
  for (; !held_.empty() && held_.front() == 0; ++oldest_held_) held_.pop_front();
}

void FragmentGrower::grow(std::int32_t seed, std::size_t target, std::size_t limit, Fragment& fragment) {
  fragment.clear();
  fragment.stamp = ++stamp_;
  held_.push_back(1);
  partly_freed_.clear();
  next_partly_freed_ = 0;
  next_vertex_ = 0;
  left_out_ = false;

  queue(seed, fragment);
  std::size_t next = 0;
  while (fragment.vertices.size() < target) {
    if (next == fragment.frontier.size() && !queue_beyond(fragment)) {
      fragment.whole_component = !left_out_;
      fragment.is_cut_off = left_out_;
      break;
    }
    vary(next, fragment);
    release(fragment.frontier[next++], limit, fragment);
  }
  fragment.frontier.erase(fragment.frontier.begin(), fragment.frontier.begin() + static_cast<std::ptrdiff_t>(next));
}

void FragmentGrower::release(std::int32_t v, std::size_t limit, Fragment& fragment) {
  fragment.released.push_back(v);
  include(v, fragment);
  for (const std::int32_t u : state_.graph().neighbours_of(v)) touch(u, v, limit, fragment);
}

// u has lost a chosen neighbour.
void FragmentGrower::touch(std::int32_t u, std::int32_t released, std::size_t limit, Fragment& fragment) {
  Mark& mark = marks_[u];
  if (mark.touched != fragment.stamp) {
    mark.touched = fragment.stamp;
    mark.released_neighbours = 0;
    mark.released_sum = 0;
  }
  ++mark.released_neighbours;
  mark.released_sum += static_cast<std::uint32_t>(released);

  const std::int32_t left = state_.tightness(u) - mark.released_neighbours;
  if (left == 0) {
    const bool claimed = mark.claim != fragment.stamp && is_held(mark.claim);
    if (claimed || fragment.vertices.size() >= limit)
      left_out_ = true;
    else
      include(u, fragment);
  } else if (left == 1) {
    queue(static_cast<std::int32_t>(state_.neighbour_sum(u) - mark.released_sum), fragment);
  } else {
    partly_freed_.push_back(u);
  }
}

void FragmentGrower::include(std::int32_t v, Fragment& fragment) {
  Mark& mark = marks_[v];
  mark.claim = fragment.stamp;
  mark.member = fragment.stamp;
  mark.index = static_cast<std::int32_t>(fragment.vertices.size());
  fragment.vertices.push_back(v);
  for (const std::int32_t u : state_.graph().neighbours_of(v))
    if (!is_held(marks_[u].claim)) marks_[u].claim = fragment.stamp;
}

void FragmentGrower::queue(std::int32_t v, Fragment& fragment) {
  Mark& mark = marks_[v];
  if (mark.queued == fragment.stamp) return;
  mark.queued = fragment.stamp;
  const bool released_by_another = mark.member != fragment.stamp && is_held(mark.member);
  if (released_by_another)
    left_out_ = true;
  else
    fragment.frontier.push_back(v);
}

// Breadth first, but not the same fragment twice from one seed: one of the next few goes first. Choosing the one that
// most vertices wait for makes compact fragments, but was worse: by 0.8 % on random-33k and 0.003 % on block-28k after
// 6 s.
void FragmentGrower::vary(std::size_t next, Fragment& fragment) {
  constexpr std::size_t few = 8;
  const std::size_t choices = std::min(few, fragment.frontier.size() - next);
  std::swap(fragment.frontier[next], fragment.frontier[next + random_.below(choices)]);
}

// Called when no vertex waits for a single chosen one any more. Queues chosen vertices beside those that wait for
// several, then chosen vertices two edges away from the fragment. False if there are none: the component is complete.
bool FragmentGrower::queue_beyond(Fragment& fragment) {
  const std::size_t before = fragment.frontier.size();
  const auto queue_chosen_at = [&](std::int32_t v) {
    state_.for_each_chosen_neighbour(v, [&](std::int32_t chosen) { queue(chosen, fragment); });
  };
  while (next_partly_freed_ < partly_freed_.size() && fragment.frontier.size() == before)
    queue_chosen_at(partly_freed_[next_partly_freed_++]);
  while (next_vertex_ < fragment.vertices.size() && fragment.frontier.size() == before)
    for (const std::int32_t u : state_.graph().neighbours_of(fragment.vertices[next_vertex_++]))
      if (marks_[u].touched != fragment.stamp && !state_.contains(u)) queue_chosen_at(u);
  return fragment.frontier.size() > before;
}

void FragmentGrower::extract(const Fragment& fragment, ground::DenseGraph& graph,
                             std::vector<bits::Word>& chosen) const {
  graph.reset(fragment.vertices.size());
  chosen.assign(graph.words(), 0);
  for (std::size_t i = 0; i < fragment.vertices.size(); ++i) {
    const std::int32_t v = fragment.vertices[i];
    graph.set_weight(i, state_.graph().weights[v]);
    if (state_.contains(v)) bits::insert(chosen.data(), i);
    bits::Word* const row = graph.row(i);
    for (const std::int32_t u : state_.graph().neighbours_of(v))
      if (marks_[u].member == fragment.stamp) bits::insert(row, static_cast<std::size_t>(marks_[u].index));
  }
}

void FragmentGrower::extract(const Fragment& fragment, graph::ConflictGraph& graph,
                             graph::IndependentSet& chosen) const {
  graph = {};
  chosen.clear();
  for (std::size_t i = 0; i < fragment.vertices.size(); ++i) {
    const std::int32_t v = fragment.vertices[i];
    if (state_.contains(v)) chosen.push_back(static_cast<std::int32_t>(i));
    graph.weights.push_back(state_.graph().weights[v]);
    for (const std::int32_t u : state_.graph().neighbours_of(v))
      if (marks_[u].member == fragment.stamp) graph.neighbours.push_back(marks_[u].index);
    graph.offsets.push_back(static_cast<std::int64_t>(graph.neighbours.size()));
  }
}

void FragmentGrower::sort(Fragment& fragment) {
  std::ranges::sort(fragment.vertices);
  for (std::size_t i = 0; i < fragment.vertices.size(); ++i)
    marks_[fragment.vertices[i]].index = static_cast<std::int32_t>(i);
}

}  // namespace hexpipe::mwis::local_search
