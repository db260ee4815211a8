#pragma once
// The search for graphs whose solutions have few vertices. It makes many short coolings of a walk over pushes, not a
// long one, and takes turns with a tabu search over pushes. On such graphs it is a matter of luck in which basin a
// cooling ends, and most coolings have found their best after a moment.

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
  // Whether they suit the graph, if its solutions have about this many vertices.
  static bool suit(const graph::ConflictGraph& graph, std::int64_t chosen);

  // `start` must be independent.
  ShortCoolings(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random);

  // Searches for as long as it takes to touch `touched` more neighbours, from where the last call ended; less if the
  // deadline passes.
  void run(double touched, const Deadline& deadline);

  std::int64_t best_weight() const { return tabu_is_ahead() ? tabu_->best_weight() : walk_.best_weight(); }
  graph::IndependentSet best() const { return tabu_is_ahead() ? tabu_->best() : walk_.best(); }
  std::int32_t vertex_count() const { return walk_.vertex_count(); }
  // The work done, in neighbours touched.
  double touched() const;
  // Vertices drawn.
  std::int64_t trials() const { return walk_.trials(); }
  // The cooling it is at, from 1.
  std::int64_t coolings() const { return coolings_; }
  // Where most coolings find their best, in units of weight.
  double usual_temperature() const { return usual_temperature_; }

 private:
  bool tabu_is_ahead() const { return tabu_ && tabu_->best_weight() > walk_.best_weight(); }
  void cool(std::int64_t trials, const Deadline& deadline);
  double touched_by_walk() const;
  void begin_cooling();
  void end_cooling();
  double temperature() const;

  PushWalk walk_;
  std::optional<PushTabu> tabu_;
  std::int64_t trials_a_unit_;
  double usual_temperature_;
  std::int64_t coolings_ = 0;
  double granted_ = 0;                  // neighbours of all calls
  std::int64_t trials_ = 0, done_ = 0;  // of this cooling
  double hot_ = 0, cold_ = 0;
  std::int64_t heaviest_ = 0;  // of this cooling
  double temperature_of_heaviest_ = 0;
};

}  // namespace hexpipe::mwis::local_search
