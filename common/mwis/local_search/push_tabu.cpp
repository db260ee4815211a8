#include "common/mwis/local_search/push_tabu.hpp"

#include <algorithm>
#include <bit>

namespace hexpipe::mwis::local_search {
namespace {

// Of the shortest start. On C2000.9-w it finds 10,999 as often with 30,000 as with a million; on frb59-26-5-w longer
// ones find more.
constexpr std::int64_t least_in_vain = 20'000;
constexpr std::int64_t moves_a_look_at_the_clock = 256;
// Measured on C2000.9-w and frb59-26-5-w, where a move changes three vertices: to change one takes as long as to touch
// a neighbour for each of so many vertices.
constexpr double touched_a_move = 4, vertices_a_touched = 60;

}  // namespace

std::int64_t luby(std::int64_t i) {
  for (auto k = static_cast<std::uint64_t>(i);;) {
    const std::uint64_t next = std::bit_ceil(k + 1);
    if (k + 1 == next) return static_cast<std::int64_t>(next / 2);
    k -= next / 2 - 1;
  }
}

PushTabu::PushTabu(const graph::ConflictGraph& graph, Random random)
    : graph_(ground::dense_graph_of(graph)),
      random_(random),
      gains_(PushGains::make(graph_)),
      chosen_(graph_.words(), 0),
      pushed_out_(graph_.words(), 0),
      best_(graph_.words(), 0) {}

void PushTabu::run(std::int64_t moves, const Deadline& deadline, double most_touched) {
  if (graph_.size() == 0) return;
  for (std::int64_t i = 0; i < moves && touched_ < most_touched; ++i) {
    if (i % moves_a_look_at_the_clock == 0 && deadline.passed()) break;
    if (in_vain_ == most_in_vain_) begin();
    move();
  }
}

// Most starts have the best tenure so far, and only these are long; one in eight has the next shorter one, one the next
// longer one, one any.
void PushTabu::begin() {
  if (starts_ > 0) end();
  ++starts_;
  heaviest_ = 0;
  in_vain_ = 0;
  most_in_vain_ = least_in_vain;
  const std::size_t best = best_tenure();
  const std::uint64_t draw = random_.below(8);
  tenure_ = best;
  if (draw == 0) tenure_ = random_.below(tenures.size());
  if (draw == 1 && best > 0) tenure_ = best - 1;
  if (draw == 2 && best + 1 < tenures.size()) tenure_ = best + 1;
  if (tenure_ == best && experience_[best].starts > 0) most_in_vain_ *= luby(++long_starts_);
}

void PushTabu::end() {
  Experience& experience = experience_[tenure_];
  ++experience.starts;
  experience.reached += (static_cast<double>(heaviest_) - experience.reached) / static_cast<double>(experience.starts);
  for (std::vector<std::size_t>& vertices : free_at_) free_tabu(vertices);
  bits::for_each(chosen_.data(), chosen_.size(), [&](std::size_t v) {
    go_out(v);
    gains_->free(v);
  });
}

// The one whose starts reach most in the mean, after one start with each.
std::size_t PushTabu::best_tenure() const {
  const auto untried = std::ranges::find(experience_, 0, &Experience::starts);
  const auto best =
      untried != experience_.end() ? untried : std::ranges::max_element(experience_, {}, &Experience::reached);
  return static_cast<std::size_t>(best - experience_.begin());
}

void PushTabu::move() {
  ++moves_;
  ++in_vain_;
  free_tabu(free_at_[static_cast<std::size_t>(moves_) % free_at_.size()]);
  if (!gains_->settle()) {
    touched_ += touched_a_move;
    return;
  }
  const std::size_t v = gains_->greatest(random_);
  const bits::Word* const row = graph_.row(v);
  for (std::size_t w = 0; w < chosen_.size(); ++w) pushed_out_[w] = chosen_[w] & row[w];
  std::size_t changed = 1;
  bits::for_each(pushed_out_.data(), pushed_out_.size(), [&](std::size_t u) {
    ++changed;
    go_out(u);
    const std::int64_t until = moves_ + tenures[tenure_] +
                               static_cast<std::int64_t>(random_.below(static_cast<std::uint64_t>(tenures[tenure_])));
    free_at_[static_cast<std::size_t>(until) % free_at_.size()].push_back(u);
  });
  come_in(v);
  touched_ += touched_a_move + static_cast<double>(changed) * static_cast<double>(graph_.size()) / vertices_a_touched;
  if (weight_ <= heaviest_) return;
  heaviest_ = weight_;
  in_vain_ = 0;
  if (weight_ <= best_weight_) return;
  best_weight_ = weight_;
  best_ = chosen_;
}

void PushTabu::come_in(std::size_t v) {
  bits::insert(chosen_.data(), v);
  weight_ += graph_.weight(v);
  gains_->bar(v);
  gains_->come_in(v);
}

// It stays barred.
void PushTabu::go_out(std::size_t v) {
  bits::erase(chosen_.data(), v);
  weight_ -= graph_.weight(v);
  gains_->go_out(v);
}

void PushTabu::free_tabu(std::vector<std::size_t>& vertices) {
  for (const std::size_t v : vertices) gains_->free(v);
  vertices.clear();
}

graph::IndependentSet PushTabu::best() const {
  graph::IndependentSet set;
  bits::for_each(best_.data(), best_.size(), [&](std::size_t v) { set.push_back(static_cast<std::int32_t>(v)); });
  return set;
}

bool PushTabu::check() const {
  std::vector<bool> barred(graph_.size());
  std::int64_t weight = 0;
  bool independent = true;
  bits::for_each(chosen_.data(), chosen_.size(), [&](std::size_t v) {
    barred[v] = true;
    weight += graph_.weight(v);
  });
  for (const std::vector<std::size_t>& vertices : free_at_)
    for (const std::size_t v : vertices) barred[v] = true;
  gains_->settle();
  for (std::size_t v = 0; v < graph_.size(); ++v) {
    std::int64_t gain = graph_.weight(v);
    bits::for_each(chosen_.data(), chosen_.size(), [&](std::size_t u) {
      if (!graph_.has_edge(u, v)) return;
      gain -= graph_.weight(u);
      independent = independent && !bits::test(chosen_.data(), v);
    });
    if (!barred[v] && gains_->gain(v) != gain) return false;
  }
  return independent && weight == weight_;
}

}  // namespace hexpipe::mwis::local_search
