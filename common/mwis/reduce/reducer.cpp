#include "common/mwis/reduce/reducer.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace hexpipe::mwis::reduce {
namespace {

// Places count from the second word of a row, so that a vertex that is nowhere has a bit, too, in the first word. Rows
// are then built without branches, which processors would predict wrong half of the time. Where a row is one word, as
// nearly always, each vertex has the word that it adds.
constexpr std::int32_t nowhere = 0, first_place = 64;
constexpr std::int32_t place_of(std::size_t i) {
  return first_place + static_cast<std::int32_t>(i);
}
constexpr std::size_t index_of(std::int32_t place) {
  return static_cast<std::size_t>(place - first_place);
}

// Neighbourhoods are examined up to this size. Beyond it, the cost (its square) exceeds what hubs ever gave.
constexpr std::size_t largest_neighbourhood = 512;
// Quick reductions end when, among this many vertices examined, fewer than this many were decided. On conflict graphs
// of meshes, where vertices of low degree come first, that keeps the work that decides 3 % of the vertices and saves
// two thirds of the time.
constexpr std::size_t window = 1024;
constexpr std::int32_t least_yield = 16;
// Sets are enumerated around vertices up to this degree, and up to this many more sets than neighbours.
constexpr std::size_t largest_folded = 96;
constexpr std::size_t most_added = 256;
// For reductions that have to be worth their work. One vertex fewer saves a search little on sparse graphs, but
// reductions often decide all vertices: deciding a vertex takes 3 to 50 us on roads and 190 us on a finite element
// mesh, and their kernels are then (nearly) empty. Graphs of hexes have a degree of 50 to 80. There, all but the quick
// rules take 6 ms per vertex before they come to folds that add vertices, and 250 us then.
constexpr double sparse_degree = 16, pay_in_sparse = 3e5, pay_in_dense = 1e5;
// May be spent before anything is decided: a fiftieth of a short search, or enough for small graphs of hexes to be
// reduced completely.
constexpr double first_in_sparse = 3e8, first_in_dense = 1.5e7, first_in_small = 4e8;
constexpr std::int32_t small_count = 4096;
constexpr double small_degree = 100;
// Measured on roads and block-28k: the work of examining a vertex, a neighbour of a neighbour, and a set.
constexpr double work_a_look = 150, work_a_neighbour = 2, work_a_set = 30;
// Searching a list for a number takes as long as marking this many numbers.
constexpr std::size_t a_search = 8;
// A try that removed nothing after this many vertices were examined is given up. Cascades that are worth it have
// removed hundreds by then.
constexpr std::size_t patience = 2048;

// Whether a set includes one of those before it. A word that told it from one of them most often tells it from the next.
bool includes_one_of(const bits::Word* set, const bits::Word* others, std::size_t words) {
  std::size_t telling = 0;
  for (const bits::Word* other = others; other != set; other += words) {
    if ((other[telling] & ~set[telling]) != 0) continue;
    std::size_t w = 0;
    while (w < words && (other[w] & ~set[w]) == 0) ++w;
    if (w == words) return true;
    telling = w;
  }
  return false;
}

// Whether a number is in an ascending list, which must not be empty. Every step is taken, so that processors have no
// branch to predict.
bool contains(std::span<const std::int32_t> ascending, std::int32_t number) {
  const std::int32_t* begin = ascending.data();
  for (std::size_t left = ascending.size(); left > 1; left -= left / 2)
    begin += begin[left / 2] <= number ? left / 2 : 0;
  return *begin == number;
}

}  // namespace

void Reducer::Queue::push(std::int32_t v) {
  if (waiting.size() <= static_cast<std::size_t>(v)) waiting.resize(static_cast<std::size_t>(v) + 1, 0);
  if (waiting[v] != 0) return;
  waiting[v] = 1;
  vertices.push_back(v);
}

std::int32_t Reducer::Queue::pop() {
  const std::int32_t v = vertices.front();
  vertices.pop_front();
  waiting[v] = 0;
  return v;
}

void Reducer::Queue::clear() {
  while (!vertices.empty()) pop();
}

Reducer::Reducer(const graph::ConflictGraph& graph, ReductionLog& log, std::vector<char> incomplete)
    : graph_(graph),
      log_(log),
      incomplete_(std::move(incomplete)),
      growth_(graph.weights.size(), unknown),
      places_(graph.weights.size(), nowhere),
      word_of_(graph.weights.size(), 0) {
  std::vector<std::int32_t> order(graph.weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::int32_t v) { return graph.degree(v); });
  for (const std::int32_t v : order) queue_.push(v);
}

std::int64_t Reducer::run(ReductionEffort effort, const Deadline& deadline) {
  if (effort == ReductionEffort::quick) {
    skim(deadline);
  } else if (effort == ReductionEffort::worth) {
    reduce_while_worth(deadline);
  } else {
    settle(deadline, 0);
    if (effort == ReductionEffort::thorough) blow_up(deadline);
  }
  return offset_;
}

void Reducer::reduce_while_worth(const Deadline& deadline) {
  skim(deadline);
  open_budget();
  settle(deadline, 0);
  if (!is_worth_it()) return;
  open_budget();
  blow_up(deadline);
}

void Reducer::open_budget() {
  const std::int32_t alive = graph_.alive_count();
  double degrees = 0;
  for (std::int32_t v = 0; v < graph_.vertex_count(); ++v)
    if (graph_.alive(v)) degrees += static_cast<double>(graph_.neighbours_of(v).size());
  const double degree = degrees / std::max(1, alive);
  const bool sparse = degree <= sparse_degree, small = alive <= small_count && degree <= small_degree;
  const double first = small ? first_in_small : sparse ? first_in_sparse : first_in_dense;
  budget_ = {first, first, small || sparse ? pay_in_sparse : pay_in_dense, alive, work_};
}

// Without a budget, everything is worth it. The outcome of a try is not known before its end.
bool Reducer::is_worth_it() {
  if (!budget_) return true;
  if (!trying_) {
    const double earned = budget_->pay * (budget_->alive - graph_.alive_count());
    budget_->left = std::min(budget_->most, budget_->left + earned) - (work_ - budget_->work);
    budget_->alive = graph_.alive_count();
    budget_->work = work_;
  }
  return budget_->left > 0;
}

void Reducer::skim(const Deadline& deadline) {
  std::int32_t left = graph_.alive_count();
  for (std::size_t seen = 1; !queue_.vertices.empty(); ++seen) {
    const std::int32_t v = queue_.pop();
    if (graph_.alive(v) && is_complete(v)) decide(v);
    if (seen % 64 == 0 && deadline.passed()) break;
    if (seen % window != 0) continue;
    if (left - graph_.alive_count() < least_yield) break;
    left = graph_.alive_count();
  }
}

// Ends early if at least `wanted` vertices are left for too long; never early if `wanted` is 0.
void Reducer::settle(const Deadline& deadline, std::int32_t wanted) {
  for (std::size_t seen = 1; !queue_.vertices.empty() || !set_queue_.vertices.empty(); ++seen) {
    const bool quick = !queue_.vertices.empty();
    const std::int32_t v = quick ? queue_.pop() : set_queue_.pop();
    if (graph_.alive(v) && is_complete(v)) quick ? decide(v) : decide_by_sets(v);
    if (seen % 64 == 0 && (deadline.passed() || !is_worth_it())) break;
    if (wanted > 0 && seen % patience == 0 && graph_.alive_count() >= wanted) break;
  }
}

// Tries folds that add vertices, those that add fewest first, and keeps them if fewer vertices are left in the end
// (cyclic blow-up, Gellner et al. 2021).
void Reducer::blow_up(const Deadline& deadline) {
  while (!growths_.empty() && !deadline.passed() && is_worth_it()) {
    const auto [growth, v] = growths_.top();
    growths_.pop();
    // Tries that were taken back leave entries of vertices that no longer exist.
    if (v < graph_.vertex_count() && graph_.alive(v) && growth_[v] == growth) try_fold(v, deadline);
  }
}

void Reducer::try_fold(std::int32_t v, const Deadline& deadline) {
  growth_[v] = unknown;
  if (!find_sets(v)) return;
  const std::int32_t before = graph_.alive_count();
  const std::size_t decided = log_.size();
  const std::int64_t offset = offset_;
  graph_.mark();
  growth_before_.clear();
  trying_ = true;
  fold(v);
  settle(deadline, before);
  trying_ = false;
  if (graph_.alive_count() >= before) take_back(decided, offset);
}

void Reducer::take_back(std::size_t decided, std::int64_t offset) {
  graph_.rollback();
  queue_.clear();
  set_queue_.clear();
  log_.forget(decided);
  offset_ = offset;
  const auto count = static_cast<std::size_t>(graph_.vertex_count());
  places_.resize(count);
  word_of_.resize(count);
  growth_.resize(count);
  for (auto before = growth_before_.rbegin(); before != growth_before_.rend(); ++before) {
    const auto& [growth, v] = *before;
    if (v >= graph_.vertex_count()) continue;
    growth_[v] = growth;
    if (growth != unknown) growths_.emplace(growth, v);
  }
}

void Reducer::estimate(std::int32_t v, std::int32_t growth) {
  if (growth_[v] == growth) return;
  if (trying_) growth_before_.emplace_back(growth_[v], v);
  growth_[v] = growth;
  if (growth != unknown) growths_.emplace(growth, v);
}

// The rules that clique covers can prove.
void Reducer::decide(std::int32_t v) {
  const std::int64_t weight = graph_.weight(v);
  if (weight == 0) return drop(v);
  if (!gather_around(v)) return;
  if (!may_decide(weight)) {
    count_look();
    return set_queue_.push(v);
  }
  sort_around();
  build_rows();
  if (bound_without(nullptr, weight)) return take(v);
  if (!drop_replaceable(v)) set_queue_.push(v);
}

// Whether the bounds of decide can hold: a bound is no less than the heaviest vertex that it is for. So a neighbour can
// be dropped only if all that are too heavy to stay beside it are in conflict with it. The few heaviest ones tell this
// of most neighbours, while rows, and the order that they need, take ten times as long.
bool Reducer::may_decide(std::int64_t weight) {
  open_.clear();
  for (const auto& [of_one, u] : by_weight_)
    if (of_one <= weight) open_.push_back({of_one, u});
  for (auto heaviest = by_weight_.begin(); heaviest != by_weight_.end(); ++heaviest) {
    std::iter_swap(heaviest, std::ranges::max_element(heaviest, by_weight_.end(), {}, &Weighted::weight));
    const auto [heavy, x] = *heaviest;
    if (heavy <= weight && heaviest == by_weight_.begin()) return true;
    const auto has_room = [&](const Weighted& u) { return heavy <= weight - u.weight; };
    if (std::ranges::any_of(open_, has_room)) return true;
    keep_open_beside(x);
    if (open_.empty()) return false;
  }
  return true;
}

// Leaves of open_ only x and what is in conflict with it.
void Reducer::keep_open_beside(std::int32_t x) {
  const auto neighbours = graph_.neighbours_of(x);
  if (open_.size() * a_search <= neighbours.size()) {
    std::erase_if(open_, [&](const Weighted& u) { return u.vertex != x && !contains(neighbours, u.vertex); });
    return;
  }
  for (const std::int32_t u : neighbours) places_[u] = first_place;
  std::erase_if(open_, [&](const Weighted& u) { return u.vertex != x && places_[u.vertex] == nowhere; });
  for (const std::int32_t u : neighbours) places_[u] = nowhere;
}

// False if there are too many neighbours.
bool Reducer::gather_around(std::int32_t v) {
  const auto neighbours = graph_.neighbours_of(v);
  if (neighbours.size() > largest_neighbourhood) return false;
  by_weight_.clear();
  for (const std::int32_t u : neighbours) by_weight_.push_back({graph_.weight(u), u});
  return true;
}

void Reducer::sort_around() {
  std::ranges::sort(by_weight_, [](const Weighted& a, const Weighted& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.vertex < b.vertex;
  });
  around_.clear();
  for (const Weighted& u : by_weight_) around_.push_back(u.vertex);
}

// The same whether rows are built or not, so that a budget decides as many vertices.
void Reducer::count_look() {
  work_ += work_a_look;
  for (const Weighted& u : by_weight_)
    work_ += work_a_neighbour * static_cast<double>(graph_.neighbours_of(u.vertex).size());
}

void Reducer::build_rows() {
  build_rows_while([](std::size_t) { return true; });
}

// Calls wanted(i) after row i was built, and ends with false where it does.
template <class Wanted>
bool Reducer::build_rows_while(Wanted&& wanted) {
  count_look();
  local_.reset(around_.size());
  set_.assign(local_.words(), 0);
  excluded_.assign(local_.words(), 0);
  for (std::size_t i = 0; i < around_.size(); ++i) {
    set_place(around_[i], i);
    local_.set_weight(i, by_weight_[i].weight);
  }
  bool all = true;
  for (std::size_t i = 0; i < around_.size() && all; ++i) {
    build_row(around_[i], local_.row(i));
    all = wanted(i);
  }
  for (const std::int32_t u : around_) places_[u] = nowhere, word_of_[u] = 0;
  return all;
}

void Reducer::set_place(std::int32_t v, std::size_t i) {
  if (local_.words() == 1)
    word_of_[v] = bits::Word{1} << i;
  else
    places_[v] = place_of(i);
}

// The row gets the neighbours of v that have places. With several words, a vertex that is nowhere is marked in the
// first one, which is then dropped.
void Reducer::build_row(std::int32_t v, bits::Word* row) {
  if (local_.words() == 1) {
    bits::Word word = 0;
    for (const std::int32_t u : graph_.neighbours_of(v)) word |= word_of_[u];
    *row = word;
    return;
  }
  std::array<bits::Word, 1 + bits::words_for(largest_neighbourhood)> marked{};
  for (const std::int32_t u : graph_.neighbours_of(v))
    bits::insert(marked.data(), static_cast<std::size_t>(places_[u]));
  std::copy_n(marked.begin() + 1, local_.words(), row);
}

// Whether a clique cover shows that no independent set of neighbours, without those in `excluded`, outweighs `limit`.
bool Reducer::bound_without(const bits::Word* excluded, std::int64_t limit) {
  bits::fill(set_.data(), around_.size());
  if (excluded != nullptr)
    for (std::size_t w = 0; w < set_.size(); ++w) set_[w] &= ~excluded[w];
  return bound_.at_most(local_, set_.data(), limit);
}

// Drops neighbours that v can replace, together with all that v pushes out beside them.
bool Reducer::drop_replaceable(std::int32_t v) {
  std::vector<bits::Word> dropped(local_.words(), 0);
  bool any = false;
  for (std::size_t i = around_.size(); i-- > 0;) {
    const std::int64_t allowance = graph_.weight(v) - local_.weight(i);
    if (allowance < 0) break;
    for (std::size_t w = 0; w < excluded_.size(); ++w) excluded_[w] = local_.row(i)[w] | dropped[w];
    bits::insert(excluded_.data(), i);
    if (!bound_without(excluded_.data(), allowance)) continue;
    bits::insert(dropped.data(), i);
    drop(around_[i]);
    any = true;
  }
  return any;
}

void Reducer::decide_by_sets(std::int32_t v) {
  estimate(v, unknown);
  if (!find_sets(v)) return;
  if (heavy_sets_.size() == 0) return take(v);
  if (drop_outside_sets()) return;
  const auto growth = static_cast<std::int32_t>(sets_.size()) - static_cast<std::int32_t>(around_.size()) - 1;
  if (growth < 0) return fold(v);
  estimate(v, growth);
}

bool Reducer::find_sets(std::int32_t v) {
  if (static_cast<std::size_t>(graph_.neighbours_of(v).size()) > largest_folded || !gather_around(v)) return false;
  sort_around();
  const std::size_t most = around_.size() + most_added;
  if (!build_rows_of_few_sets(graph_.weight(v), most)) {
    work_ += work_a_set * static_cast<double>(most);
    return false;
  }
  const bool found = heavy_sets_.find(local_, graph_.weight(v), most, static_cast<std::int64_t>(2 * most));
  work_ += work_a_set * static_cast<double>(heavy_sets_.size());
  if (!found) return false;
  collect_sets();
  return true;
}

// False, before most rows are built, if there are more than `most` sets heavier than `limit` that have one or two
// vertices.
bool Reducer::build_rows_of_few_sets(std::int64_t limit, std::size_t most) {
  std::size_t sets = 0, partners = around_.size();  // those not too light for the vertex come first
  return build_rows_while([&](std::size_t i) {
    const std::int64_t weight = local_.weight(i);
    if (weight > limit) ++sets;
    while (partners > 0 && weight + local_.weight(partners - 1) <= limit) --partners;
    if (partners <= i + 1) return true;
    sets += partners - i - 1 - bits::count_between(local_.row(i), i + 1, partners);
    return sets <= most;
  });
}

bool Reducer::drop_outside_sets() {
  for (std::size_t i = 0; i < heavy_sets_.size(); ++i)
    for (std::size_t w = 0; w < excluded_.size(); ++w) excluded_[w] |= heavy_sets_.set(i)[w];
  bool any = false;
  for (std::size_t i = 0; i < around_.size(); ++i) {
    if (bits::test(excluded_.data(), i)) continue;
    drop(around_[i]);
    any = true;
  }
  return any;
}

// Keeps the heavy sets that no other one replaces. A set replaces another if it is at least as heavy and has no more
// conflicts outside.
void Reducer::collect_sets() {
  look_outside();
  set_order_.clear();
  for (std::size_t i = 0; i < heavy_sets_.size(); ++i) set_order_.emplace_back(-heavy_sets_.weight(i), i);
  std::ranges::sort(set_order_);
  sets_.clear();
  set_conflicts_.resize(std::max(set_conflicts_.size(), set_order_.size() * outside_words_));
  bits::Word* row = set_conflicts_.data();
  for (const auto& [lightness, i] : set_order_) {
    std::fill_n(row, outside_words_, 0);
    bits::for_each(heavy_sets_.set(i), local_.words(), [&](std::size_t j) {
      for (std::size_t w = 0; w < outside_words_; ++w) row[w] |= conflicts_[j * outside_words_ + w];
    });
    if (includes_one_of(row, set_conflicts_.data(), outside_words_)) continue;
    sets_.push_back(i);
    row += outside_words_;
  }
}

void Reducer::look_outside() {
  // Marks the neighbourhood as well, so that it does not count as outside.
  for (const std::int32_t u : around_) places_[u] = first_place;
  outside_.clear();
  for (const std::int32_t u : around_)
    for (const std::int32_t x : graph_.neighbours_of(u))
      if (places_[x] == nowhere) {
        places_[x] = first_place;
        outside_.push_back(x);
      }
  for (const std::int32_t u : around_) places_[u] = nowhere;
  std::ranges::sort(outside_);
  for (std::size_t i = 0; i < outside_.size(); ++i) places_[outside_[i]] = place_of(i);
  outside_words_ = bits::words_for(outside_.size());
  conflicts_.assign(around_.size() * outside_words_, 0);
  for (std::size_t j = 0; j < around_.size(); ++j) {
    const auto neighbours = graph_.neighbours_of(around_[j]);
    work_ += 2 * work_a_neighbour * static_cast<double>(neighbours.size());
    for (const std::int32_t x : neighbours)
      if (places_[x] != nowhere) bits::insert(conflicts_.data() + j * outside_words_, index_of(places_[x]));
  }
  for (const std::int32_t x : outside_) places_[x] = nowhere;
}

void Reducer::fold(std::int32_t v) {
  const std::int64_t weight = graph_.weight(v);
  offset_ += weight;
  log_.begin_fold(v, graph_.vertex_count());
  graph_.remove(v);
  for (const std::int32_t u : around_) drop(u);
  const std::int32_t first = graph_.vertex_count();
  std::vector<std::int32_t> members, neighbours;
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    members.clear();
    bits::for_each(heavy_sets_.set(sets_[i]), local_.words(), [&](std::size_t j) { members.push_back(around_[j]); });
    log_.add_set(members);
    neighbours.clear();
    bits::for_each(set_conflicts_.data() + i * outside_words_, outside_words_, [&](std::size_t j) {
      if (outside_[j] != v) neighbours.push_back(outside_[j]);
    });
    for (std::int32_t other = first; other < graph_.vertex_count(); ++other) neighbours.push_back(other);
    queue_.push(graph_.add(heavy_sets_.weight(sets_[i]) - weight, neighbours));
    places_.push_back(nowhere);
    word_of_.push_back(0);
    growth_.push_back(unknown);
  }
  for (std::int32_t created = first; created < graph_.vertex_count(); ++created)
    for (const std::int32_t u : graph_.neighbours_of(created)) queue_.push(u);
}

void Reducer::take(std::int32_t v) {
  offset_ += graph_.weight(v);
  log_.take(v);
  const auto neighbours = graph_.neighbours_of(v);
  around_.assign(neighbours.begin(), neighbours.end());
  graph_.remove(v);
  for (const std::int32_t u : around_) drop(u);
}

void Reducer::drop(std::int32_t v) {
  graph_.remove(v);
  for (const std::int32_t u : graph_.neighbours_of(v)) queue_.push(u);
}

}  // namespace hexpipe::mwis::reduce
