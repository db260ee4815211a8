#pragma once
// Measures where a tool spends its time, for --stats.

#include <ctime>
#include <nlohmann/json.hpp>
#include <string>

#include "common/run/deadline.hpp"

namespace hexpipe {

// The first phase begins with construction.
class Phases {
 public:
  // Ends the current phase and gives it a name.
  void end(const std::string& name) {
    const std::clock_t cpu = std::clock();
    const double wall = stopwatch_.seconds();
    seconds_["cpu_seconds"][name] = static_cast<double>(cpu - cpu_began_) / CLOCKS_PER_SEC;
    seconds_["wall_seconds"][name] = wall - wall_began_;
    cpu_began_ = cpu;
    wall_began_ = wall;
  }
  // The cpu_seconds (of all threads) and wall_seconds of each phase.
  const nlohmann::ordered_json& seconds() const { return seconds_; }

 private:
  Stopwatch stopwatch_;
  std::clock_t cpu_began_ = std::clock();
  double wall_began_ = 0;
  nlohmann::ordered_json seconds_{{"cpu_seconds", nlohmann::ordered_json::object()},
                                  {"wall_seconds", nlohmann::ordered_json::object()}};
};

}  // namespace hexpipe
