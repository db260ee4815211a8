#pragma once
// A random walk over independent sets: a random vertex comes in and its chosen neighbours go out, if Metropolis' rule
// accepts that. No local search follows, and nothing has to be undone, so a refused vertex costs some nanoseconds.
// Where few vertices are chosen this visits many more sets than kicks do (annealing.hpp).

#include <cstdint>
#include <vector>

#include "common/mwis/ground/solution_state.hpp"
#include "common/run/deadline.hpp"
#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

class PushWalk {
 public:
  // `start` must be independent. It is made maximal.
  PushWalk(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random);

  // Draws `trials` vertices at this temperature, which is in units of weight and above 0; fewer if the deadline passes.
  // Returns the greatest weight on the way.
  std::int64_t run(std::int64_t trials, double temperature, const Deadline& deadline);

  // The vertices drawn, and the total number of neighbours of those that went in or out. Both take time.
  std::int64_t trials() const { return trials_; }
  std::int64_t touched() const { return touched_; }
  std::int32_t vertex_count() const { return state_.graph().vertex_count(); }
  std::int64_t best_weight() const { return best_weight_; }
  graph::IndependentSet best() const { return is_at_best_ ? state_.to_set() : best_; }

  // Whether the state is right; for tests.
  bool check() const { return state_.check(); }

 private:
  void push(std::int32_t v);

  Random random_;
  ground::SolutionState state_;
  std::vector<std::int32_t> pushed_out_;
  std::int64_t trials_ = 0, touched_ = 0;
  std::int64_t best_weight_;
  bool is_at_best_ = true;  // the best solution is the current one; otherwise it is stored
  graph::IndependentSet best_;
};

}  // namespace hexpipe::mwis::local_search
