#pragma once
// When going on is not worth it: a search ends when the last half of its work gained too little.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace hexpipe::mwis::local_search {

// Counts work, not seconds, so that a search ends at the same place on every machine.
class StopRule {
 public:
  // `least_gain` is for the last half, in units of weight; 0: the search goes on for ever. Nothing is judged before
  // `least_work`, unless all of the graph is seen and all gains together are less than `least_gain`. Between it and
  // `whole_work` the search has seen a sample of the graph, and is judged by what it would gain if it went on to the
  // whole work as it did in its last half. While all gains together are less than `least_gain`, it is expected to go on
  // to `most_times` its work at most.
  StopRule(double least_gain, double least_work, double whole_work)
      : least_gain_(least_gain), least_work_(least_work), whole_work_(whole_work) {}

  // The total work done and the weight reached; neither decreases. `most_times`: after so many times the work, the
  // search has seen enough of the graph. `has_seen_all`: it has gone over all of the graph once.
  void record(double work, std::int64_t weight, double most_times = std::numeric_limits<double>::infinity(),
              bool has_seen_all = false);
  bool is_done() const;

 private:
  struct Point {
    double work;
    std::int64_t weight;
  };

  double least_gain_, least_work_, whole_work_;
  double work_ = 0, most_times_ = std::numeric_limits<double>::infinity();
  bool has_seen_all_ = false;
  std::vector<Point> points_;  // the points where the weight rose
  std::size_t half_ = 0;       // the last of them in the first half of the work, if there is one
};

}  // namespace hexpipe::mwis::local_search
