#pragma once
// Simulated annealing from one local optimum to the next. A kick forces a random vertex in or out; pushes (a vertex
// comes in, its chosen neighbours go out) and (1,2)-swaps make the surroundings locally optimal again. Metropolis' rule
// accepts a loss or undoes all of it. The moves are those of iterated local search for independent sets (Andrade,
// Resende, Werneck 2012; Nogueira, Pinheiro, Subramanian 2018); the acceptance is that of basin hopping (Wales and Doye
// 1997). Iterated local search accepts only solutions that are not worse than the best as a whole. A temperature lets
// every region of a large graph cross its own barriers at the same time.

#include <cstdint>
#include <limits>
#include <vector>

#include "common/mwis/ground/solution_state.hpp"
#include "common/run/deadline.hpp"
#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

// Temperatures in units of the mean weight of a chosen vertex; they fall geometrically. hot 0.1 to 0.6 and cold 0.004
// to 0.04 were compared on three graphs of 28,000 to 56,000 vertices with 25 kicks per vertex. Colder starts lose up to
// 0.8 % on random points, hotter ones lose 0.01 % on the others; colder ends waste their time.
struct Cooling {
  double hot = 0.3;
  double cold = 0.03;

  // The temperature when this share of the cooling is done, from 0 to 1.
  double at(double progress) const;

  // What suits a graph of which a solution has this many vertices.
  static Cooling for_chosen(std::int64_t chosen);
};

class Annealing {
 public:
  // `start` must be independent. It is made maximal and, unless the deadline passes first, locally optimal.
  Annealing(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random,
            const Deadline& deadline = Deadline());

  // Makes `kicks` more kicks at this temperature, in units of weight. It makes fewer if the deadline passes or
  // `most_touched` neighbours are touched: a kick beside a hub moves thousands of vertices.
  void run(std::int64_t kicks, double temperature, const Deadline& deadline,
           std::int64_t most_touched = std::numeric_limits<std::int64_t>::max());

  std::int64_t kicks() const { return kicks_; }
  // The total number of neighbours of the vertices that went in or out. The time is proportional to it.
  std::int64_t touched() const { return touched_; }
  std::int64_t best_weight() const { return best_weight_; }
  graph::IndependentSet best() const;
  // The number of vertices of the current solution.
  std::int64_t chosen_count() const;
  // The mean weight of a vertex of the current solution; 1 if nothing is chosen.
  double mean_weight() const;

  // Whether the state is consistent and locally optimal; for tests.
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
  std::vector<std::int32_t> loose_;   // neighbours of a chosen vertex that only this vertex keeps out
  std::vector<std::uint32_t> marks_;  // stamp of the last vertex that this is a neighbour of
  std::uint32_t stamp_ = 0;

  std::int64_t kicks_ = 0, touched_ = 0;
  std::int64_t window_begin_ = 0;
  std::int64_t best_weight_ = 0;
  std::vector<std::int32_t> step_;  // vertices that went in or out since the kick
  // The best solution is the current one with these changes undone; or best_, once there were too many.
  std::vector<std::int32_t> since_best_;
  bool best_is_stored_ = false;
  graph::IndependentSet best_;
};

}  // namespace hexpipe::mwis::local_search
