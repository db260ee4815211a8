#pragma once
// The search in graphs of which a solution has few vertices: many short coolings of a walk over pushes, in place of one
// long one, and in turn with them a tabu search over pushes. Which basin a cooling ends in is a matter of luck there,
// and most of them end after a moment.

#include <cstdint>
#include <optional>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/local_search/push_tabu.hpp"
#include "common/mwis/local_search/push_walk.hpp"
#include "common/run/deadline.hpp"
#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

class ShortCoolings {
 public:
  // Whether they suit a graph, of which a solution has about this many vertices.
  static bool suit(const graph::ConflictGraph& graph, std::int64_t chosen);
  // Draws that take about as long as a kick of Annealing takes on such graphs.
  static constexpr std::int64_t trials_a_kick = 2000;

  // `start` must be independent.
  ShortCoolings(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random);

  // Takes as long as drawing so many more vertices; less if the deadline passes. It goes on where the last call ended.
  void run(std::int64_t trials, const Deadline& deadline);

  std::int64_t best_weight() const { return tabu_is_ahead() ? tabu_->best_weight() : walk_.best_weight(); }
  graph::IndependentSet best() const { return tabu_is_ahead() ? tabu_->best() : walk_.best(); }
  std::int32_t vertex_count() const { return walk_.vertex_count(); }
  // The work done, in neighbours touched.
  double touched() const;
  // The cooling it is at, from 1.
  std::int64_t coolings() const { return coolings_; }
  // Where most coolings find their best, in units of weight.
  double usual_temperature() const { return usual_temperature_; }

 private:
  bool tabu_is_ahead() const { return tabu_ && tabu_->best_weight() > walk_.best_weight(); }
  void cool(std::int64_t trials, const Deadline& deadline);
  double touched_by_walk() const;
  double touched_by_tabu() const;
  void begin_cooling();
  void end_cooling();
  double temperature() const;

  PushWalk walk_;
  std::optional<PushTabu> tabu_;
  std::int64_t trials_a_unit_;
  double usual_temperature_;
  std::int64_t coolings_ = 0;
  std::int64_t granted_ = 0;            // trials of all calls, those that the tabu search gets among them
  std::int64_t trials_ = 0, done_ = 0;  // of this cooling
  double hot_ = 0, cold_ = 0;
  std::int64_t heaviest_ = 0;  // of this cooling
  double temperature_of_heaviest_ = 0;
};

}  // namespace hexpipe::mwis::local_search
