#pragma once
// Simulated annealing for cells that are worth much and leave few quads open. A move forces a random candidate in, and
// what is in conflict with it out, or a chosen one out; candidates that this set free come in while they gain, and a
// loss is accepted by Metropolis' rule, otherwise everything is taken back. As common/mwis/local_search/annealing.hpp,
// but there a set is worth the sum of its vertices; here two cells that share a quad are worth more than each for
// itself.

#include <array>
#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/ground/solution_state.hpp"
#include "common/mwis/local_search/annealing.hpp"
#include "common/run/random.hpp"

namespace hexpipe::assemble::choice {

// What the search chooses from. A quad is open when exactly one chosen cell has it.
struct ExchangeProblem {
  static constexpr std::int32_t none = -1;

  graph::ConflictGraph graph;                      // its weights are what candidates are worth
  std::vector<std::array<std::int32_t, 6>> quads;  // by candidate, in numbers from 0; none: no quad, or on the boundary
  std::vector<std::int64_t> cost;                  // by quad: of its being open, in units of weight
  std::vector<std::uint8_t> standing;              // by quad: how many cells have it that are not in the graph
  std::vector<double> usual;                       // by candidate: what those around it weigh
  std::vector<std::uint8_t> stays;                 // by candidate: 1 where it remains in or out, as it is at the start
};

class ExchangeSearch {
 public:
  // `start` is independent; `problem` has to outlive this.
  ExchangeSearch(const ExchangeProblem& problem, const graph::IndependentSet& start, Random random);

  // Temperatures in units of what is usual around the candidate that moves.
  void run(std::int64_t moves, const mwis::local_search::Cooling& cooling);

  // The weight of the chosen cells less the cost of open quads, now and of the best set so far.
  std::int64_t value() const { return state_.weight() - open_cost_; }
  std::int64_t best_value() const { return best_value_; }
  graph::IndependentSet best() const;

  // All that is kept agrees with the chosen cells, which are independent. For tests.
  bool check() const;

 private:
  void move(std::int32_t candidate, double least_change);
  void push(std::int32_t candidate);
  void fill_room();
  void add(std::int32_t candidate);
  void remove(std::int32_t candidate);
  void enter(std::int32_t candidate);
  std::int64_t gain_of(std::int32_t candidate) const;
  void take_back();
  void keep();
  void forget_what_came_back();

  const ExchangeProblem& problem_;
  mwis::ground::SolutionState state_;
  Random random_;
  std::vector<std::int32_t> movable_;   // candidates that need not stay
  std::vector<std::uint8_t> cells_at_;  // by quad
  std::int64_t open_cost_ = 0;
  std::int64_t best_value_ = 0;
  std::vector<std::int32_t> step_;        // candidates that went in or out in this move
  std::vector<std::int32_t> since_best_;  // since the best set was the present one
  std::vector<std::int32_t> freed_;       // candidates that nothing was in conflict with any more in this move
  std::vector<std::int32_t> pushed_out_;
};

}  // namespace hexpipe::assemble::choice
