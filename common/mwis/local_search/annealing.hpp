#pragma once
// Simulated annealing from local optimum to local optimum: a kick forces a random vertex in or out, Push and
// (1,2)-swaps settle the surroundings, and a loss is accepted by Metropolis' rule, otherwise everything is taken back.
// The moves are those of iterated local search for independent sets (Andrade, Resende, Werneck 2012; Nogueira,
// Pinheiro, Subramanian 2018), the acceptance that of basin hopping (Wales and Doye 1997). These searches accept what
// is not worse than the best as a whole; a temperature lets every part of a large graph cross its own barriers at the
// same time.

#include <cstdint>
#include <limits>
#include <vector>

#include "common/mwis/ground/solution_state.hpp"
#include "common/run/deadline.hpp"
#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

// Temperatures in units of the mean weight of a chosen vertex, falling geometrically.
// Of hot 0.1 to 0.6 and cold 0.004 to 0.04 on three graphs of 28,000 to 56,000 vertices with 25 kicks a vertex: colder
// starts lose up to 0.8 % on random points, hotter ones 0.01 % on the others; colder ends waste their time.
struct Cooling {
  double hot = 0.3;
  double cold = 0.03;

  // `progress` from 0 to 1.
  double at(double progress) const;

  // For a graph of which so many vertices are chosen at the start.
  static Cooling for_chosen(std::int64_t chosen);
};

class Annealing {
 public:
  // `start` is independent; it is made maximal and, unless the deadline passes before, locally optimal.
  Annealing(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random,
            const Deadline& deadline = Deadline());

  // Makes `kicks` more kicks at this temperature, in units of weight, fewer when the deadline passes or `most_touched`
  // neighbours are touched: a kick beside a hub moves thousands of vertices.
  void run(std::int64_t kicks, double temperature, const Deadline& deadline,
           std::int64_t most_touched = std::numeric_limits<std::int64_t>::max());

  std::int64_t kicks() const { return kicks_; }
  // Neighbours of the vertices that went in or out, in all: what the time is proportional to.
  std::int64_t touched() const { return touched_; }
  std::int64_t best_weight() const { return best_weight_; }
  graph::IndependentSet best() const;
  // Vertices of the present solution.
  std::int64_t chosen_count() const;
  // Of a vertex of the present solution; 1 where nothing is chosen.
  double mean_weight() const;

  // The state is right, and locally optimal. For tests.
  bool check() const;

 private:
  std::int32_t next_to_kick();
  void kick(std::int32_t v);
  void settle();
  void settle_first(const Deadline& deadline);
  void settle(std::int32_t v);
  void begin_round();
  void push(std::int32_t v);
  bool swap_for_two(std::int32_t v);
  void add(std::int32_t v);
  void remove(std::int32_t v);
  void wait(std::int32_t v);
  void take_back();
  void keep();
  void count(std::int32_t v) { touched_ += state_.graph().degree(v); }
  graph::IndependentSet present_without(const std::vector<std::int32_t>& toggles) const;

  Random random_;
  ground::SolutionState state_;
  std::vector<std::int32_t> waiting_, settling_;  // vertices whose surroundings changed
  std::vector<std::uint8_t> is_waiting_;
  std::vector<std::int32_t> pushed_out_;
  std::vector<std::int32_t> loose_;   // neighbours of a chosen vertex that it alone keeps out
  std::vector<std::uint32_t> marks_;  // stamp of the last vertex whose neighbour this is
  std::uint32_t stamp_ = 0;

  std::int64_t kicks_ = 0, touched_ = 0;
  std::int64_t window_begin_ = 0;
  std::int64_t best_weight_ = 0;
  std::vector<std::int32_t> step_;  // vertices that went in or out since the kick
  // The best solution is the present one with these taken back; or best_, once they were too many.
  std::vector<std::int32_t> since_best_;
  bool best_is_stored_ = false;
  graph::IndependentSet best_;
};

}  // namespace hexpipe::mwis::local_search
