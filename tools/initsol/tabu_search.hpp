#pragma once
// Tabu search on Push (Verhetsel 2017, 3.3, algorithms 7 and 11): the vertex that gains most, or loses least, comes in;
// its chosen neighbours go out and stay out for a while. The next move is the top of an indexed priority queue of
// gains. A move changes only the gains around it.

#include <cstdint>
#include <string_view>
#include <vector>

#include "common/mwis/ground/solution_state.hpp"
#include "common/run/deadline.hpp"
#include "common/run/random.hpp"
#include "tools/initsol/indexed_heap.hpp"

namespace hexpipe::initsol {

// The way to escape after a long time without a better solution (algorithms 8, 9 and 10).
enum class Escape {
  restart,  // a random maximal independent set
  rebuild,  // a greedy set of the vertices that were moved least
  best,     // the best solution so far
};

struct TabuOptions {
  Escape escape = Escape::best;
  // A vertex that was pushed out stays out for a number of moves drawn from [tenure, 2 tenure). 200 was best among 10,
  // 30, 100, 150, 200, 300 and 1000 on graphs of 28,000 to 56,000 vertices in 3 s: with 10, the search stays in one
  // corner of the graph (0.6 to 9 % worse than the best value), with 1000 it opens more gaps than it closes.
  std::int64_t tenure = 200;
  // The search escapes after this many moves without a new best solution.
  std::int64_t patience = 100000;
};

class TabuSearch {
 public:
  TabuSearch(const graph::ConflictGraph& graph, const graph::IndependentSet& start, const TabuOptions& options,
             Random random);

  // Makes `moves` more moves, fewer when the deadline passes or no vertex can move at all.
  void run(std::int64_t moves, const Deadline& deadline);

  std::int64_t moves() const { return moves_; }
  std::int64_t best_weight() const { return best_weight_; }
  graph::IndependentSet best() const;

  // The state is right, the queues hold every vertex that is not chosen, with its gain, and none is open before its
  // tabu ends. For tests.
  bool check() const;

 private:
  struct TabuEnd {
    std::int64_t move;
    std::int32_t vertex;
    bool operator<(const TabuEnd& other) const { return move > other.move; }
  };

  void end_tabus();
  bool has_move() const { return !open_.empty() || !tabu_.empty(); }
  std::int32_t choose() const;
  void push(std::int32_t v);
  void insert(std::int32_t v);
  void remove(std::int32_t v);
  void update_gains_around(std::int32_t v);
  void note_best();
  void take_way_out();
  void return_to_best();
  void restart_at(const graph::IndependentSet& solution);
  graph::IndependentSet build_in_order(const std::vector<std::int32_t>& order) const;

  const graph::ConflictGraph& graph_;
  TabuOptions options_;
  Random random_;
  mwis::ground::SolutionState state_;
  IndexedHeap open_, tabu_;  // gains of the vertices that are not chosen
  // A heap with the earliest end first. It has outdated entries: only the last entry of a vertex counts.
  std::vector<TabuEnd> tabu_ends_;
  std::vector<std::int64_t> tabu_until_;  // by vertex: its last end
  std::vector<std::int32_t> pushed_out_;
  std::vector<std::uint32_t> moved_;  // how often each vertex went in or out

  std::int64_t moves_ = 0, last_best_move_ = 0;
  std::int64_t best_weight_ = 0;
  // The best solution is the present one with these moves taken back, last first; after another start, it is best_.
  std::vector<std::int32_t> since_best_;
  bool best_is_stored_ = false;
  graph::IndependentSet best_;
};

}  // namespace hexpipe::initsol
