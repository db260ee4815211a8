#pragma once
// Where a tool's time goes, for --stats.

#include <ctime>
#include <nlohmann/json.hpp>
#include <string>

#include "common/run/deadline.hpp"

namespace hexpipe {

// Counts from its making on.
class Phases {
 public:
  // Ends the phase that ran until now.
  void end(const std::string& name) {
    const std::clock_t cpu = std::clock();
    const double wall = stopwatch_.seconds();
    seconds_["cpu_seconds"][name] = static_cast<double>(cpu - cpu_began_) / CLOCKS_PER_SEC;
    seconds_["wall_seconds"][name] = wall - wall_began_;
    cpu_began_ = cpu;
    wall_began_ = wall;
  }
  // cpu_seconds (over all threads) and wall_seconds of each phase.
  const nlohmann::ordered_json& seconds() const { return seconds_; }

 private:
  Stopwatch stopwatch_;
  std::clock_t cpu_began_ = std::clock();
  double wall_began_ = 0;
  nlohmann::ordered_json seconds_{{"cpu_seconds", nlohmann::ordered_json::object()},
                                  {"wall_seconds", nlohmann::ordered_json::object()}};
};

}  // namespace hexpipe
