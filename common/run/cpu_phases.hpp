#pragma once
// Where a tool's processor time goes, for --stats.

#include <ctime>
#include <nlohmann/json.hpp>
#include <string>

namespace hexpipe {

// Counts from its making on, over all threads.
class CpuPhases {
 public:
  // Ends the phase that ran until now.
  void end(const std::string& name) {
    const std::clock_t now = std::clock();
    seconds_[name] = static_cast<double>(now - began_) / CLOCKS_PER_SEC;
    began_ = now;
  }
  const nlohmann::ordered_json& seconds() const { return seconds_; }

 private:
  std::clock_t began_ = std::clock();
  nlohmann::ordered_json seconds_ = nlohmann::ordered_json::object();
};

}  // namespace hexpipe
