#pragma once
// When a search should end: when the last half of its work gained too little.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace hexpipe::mwis::local_search {

// Counts work, not seconds, so that a search ends at the same place on every machine.
class StopRule {
 public:
  //   least_gain  what the last half of the work must gain, in units of weight; 0: the search never ends
  //   least_work  nothing is judged before this, unless the search has seen all of the graph and has gained less than
  //               least_gain. If most_times is known, less than ten times that is enough where the last half of the
  //               work gained nothing.
  //   whole_work  before this, the search has seen a sample of the graph. It is judged by what it would gain on the way
  //               to whole_work if it went on as in its last half. While all gains together are less than least_gain,
  //               that way goes to record()'s `most_times` of the present work at most.
  StopRule(double least_gain, double least_work, double whole_work)
      : least_gain_(least_gain), least_work_(least_work), whole_work_(whole_work) {}

  // Takes the total work done and the weight reached; neither decreases. `most_times`: after so many times this work
  // the search would have seen enough of the graph, if that is known. `has_seen_all`: it has gone over the whole graph
  // once.
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
