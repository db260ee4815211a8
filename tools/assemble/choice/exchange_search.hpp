#pragma once
// Simulated annealing for cells that are worth much and leave few quads open. A move pushes a random candidate in and
// all that are in conflict with it out, or takes a chosen one out. Candidates that this set free come in while they
// gain. A loss is accepted by Metropolis' rule. Hardly one move in fifty is accepted, so moves are planned first: that
// reads conflicts and changes counts at quads only, which are few.
// common/mwis/local_search/annealing.hpp does the same for sets that are worth the sum of their vertices; here two
// cells that share a quad are worth more together.

#include <array>
#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/vertex_items.hpp"
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
  std::int64_t value() const { return weight_ - open_cost_; }
  std::int64_t best_value() const { return best_value_; }
  graph::IndependentSet best() const;

  // Whether the chosen cells are independent and all counts agree with them. For tests.
  bool check() const;

 private:
  // What a move asks about a participant lies together: moves are at random places, and each place costs.
  struct Cell {
    std::int64_t weight;
    double usual;
    std::array<QuadIndex, 6> quads;
    // What the value changes by when this chosen one goes out, and those that it frees come in; `unknown` after a
    // change around it.
    std::int64_t change_without;
  };
  struct QuadCells {
    std::int64_t cost;
    std::uint8_t cells;
    bool operator==(const QuadCells&) const = default;
  };

  bool contains(Participant participant) const { return is_chosen_[participant] != 0; }
  auto neighbours_of(Participant participant) const {
    return as_indices<Participant>(problem_.graph.neighbours_of(static_cast<std::int32_t>(participant)));
  }
  bool are_in_conflict(Participant a, Participant b) const {
    return problem_.graph.has_edge(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
  }
  std::int64_t gain_of(Participant participant) const;
  void count_in(Participant participant);
  void count_out(Participant participant);
  void choose(Participant participant);
  void leave(Participant participant);
  void count_conflicts(Participant participant, std::int32_t more);
  void forget_change_at(Participant participant);
  void forget_changes_at_quads(Participant participant);

  std::int64_t change_of(Participant participant);
  void plan(Participant participant);
  void find_those_out(Participant participant);
  void find_freed();
  void take_in(Participant participant);
  void use_freed_room();
  void drop_plan();
  void carry_out(Participant participant);
  void keep();
  void forget_what_came_back();

  const ExchangeProblem& problem_;
  Random random_;
  std::vector<Participant> movable_;  // participants that need not stay
  IndexedVector<Participant, Cell> cells_;
  IndexedVector<QuadIndex, QuadCells> quads_;
  VertexItemsOf<Participant> owners_;  // by quad: the participants that have it
  IndexedVector<Participant, std::uint8_t> is_chosen_;
  // How many chosen ones are in conflict with it, and one more if it stays, so that no room is free for it.
  IndexedVector<Participant, std::int32_t> conflicts_;
  // The numbers of these chosen ones, exclusive-ored, so that a single one is known.
  IndexedVector<Participant, std::int32_t> rivals_;
  std::int64_t weight_ = 0, open_cost_ = 0;
  std::int64_t best_value_ = 0;
  std::vector<Participant> out_, in_;    // what a move takes out and in
  std::vector<Participant> freed_;       // participants for which a move makes room
  std::vector<Participant> since_best_;  // participants that went in or out since the best set
};

}  // namespace hexpipe::assemble::choice
