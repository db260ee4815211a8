#pragma once
// Simulated annealing for cells that are worth much and leave few quads open. A move pushes a random candidate in and
// all that are in conflict with it out, or takes a chosen one out. Candidates that this set free come in while they
// gain. A loss is accepted by Metropolis' rule; otherwise the move is taken back.
// common/mwis/local_search/annealing.hpp does the same for sets that are worth the sum of their vertices; here two
// cells that share a quad are worth more together.

#include <array>
#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/ground/solution_state.hpp"
#include "common/mwis/local_search/annealing.hpp"
#include "common/run/random.hpp"

namespace hexpipe::assemble::choice {

// A candidate that takes part, by its place in the graph of the problem.
using Participant = Index<struct ParticipantKind>;
// A quad of participants, by its number in the problem.
using QuadIndex = Index<struct QuadOfParticipants>;

// The participants to choose from. A quad is open if exactly one chosen cell has it.
struct ExchangeProblem {
  graph::ConflictGraph graph;  // its weights are the worths of the participants
  // no_index: the quad is on the boundary, or the participant has no such quad.
  IndexedVector<Participant, std::array<QuadIndex, 6>> quads;
  IndexedVector<QuadIndex, std::int64_t> cost;         // while the quad is open, in units of weight
  IndexedVector<QuadIndex, std::uint8_t> fixed_cells;  // the number of cells that have it and are not in the graph
  IndexedVector<Participant, double> usual;            // the usual weight of those around it
  IndexedVector<Participant, std::uint8_t> stays;      // 1 if it stays in or out, as it is at the start
};

class ExchangeSearch {
 public:
  // `start` is independent; `problem` outlives this.
  ExchangeSearch(const ExchangeProblem& problem, const graph::IndependentSet& start, Random random);

  // Temperatures are in units of the usual weight around the participant that moves.
  void run(std::int64_t moves, const mwis::local_search::Cooling& cooling);

  // The weight of the chosen cells less the cost of open quads: now, and for the best set so far.
  std::int64_t value() const { return state_.weight() - open_cost_; }
  std::int64_t best_value() const { return best_value_; }
  graph::IndependentSet best() const;

  // Whether the chosen cells are independent and all counts agree with them. For tests.
  bool check() const;

 private:
  void move(Participant participant, double least_change);
  void push(Participant participant);
  void use_freed_room();
  void add(Participant participant);
  void remove(Participant participant);
  void enter(Participant participant);
  std::int64_t gain_of(Participant participant) const;
  void take_back();
  void keep();
  void forget_what_came_back();

  const ExchangeProblem& problem_;
  mwis::ground::SolutionState state_;
  Random random_;
  std::vector<Participant> movable_;  // participants that need not stay
  IndexedVector<QuadIndex, std::uint8_t> cells_at_;
  std::int64_t open_cost_ = 0;
  std::int64_t best_value_ = 0;
  std::vector<Participant> step_;        // participants that went in or out during this move
  std::vector<Participant> since_best_;  // participants that went in or out since the best set
  std::vector<Participant> freed_;       // participants whose last conflict with the chosen ones ended during this move
  std::vector<Participant> pushed_out_;
};

}  // namespace hexpipe::assemble::choice
