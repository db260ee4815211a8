#pragma once
// What a tool says of itself, and what its run function is given.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/run/deadline.hpp"
#include "common/run/stream_options.hpp"

namespace hexpipe {

struct ToolInfo {
  std::string name;
  std::string summary;          // one sentence
  std::string example;          // a worked example for --help
  std::vector<Role> reads;      // roles that may come from files; the first is what a plain operand holds
  std::optional<Role> product;  // what -o FILE writes; none: the tool writes no stream
  bool random = false;          // has --seed
  bool searches = false;        // has --time-limit, --iterations and --log, and stops gracefully on signals
  std::optional<double> default_time_limit{};  // of a search that is given neither limit, seconds
  std::string ends_by_itself{};  // or when a search ends that is given neither limit
  std::string licence{"MIT"};                  // of the executable as a whole, for --version
};

struct CommonOptions {
  int threads = 0;  // 0: all
  std::uint64_t seed = 1;
  std::optional<double> time_limit;  // seconds
  std::optional<std::int64_t> iterations;
  std::optional<std::uint64_t> memory;  // bytes
  std::string stats_file;
  std::string log_file;
  bool verbose = false;
  bool quiet = false;
};

// What a tool's run function is given.
struct RunContext {
  ToolInfo info;
  CommonOptions common;
  StreamOptions streams;
  // Objects from the beginning: what becomes one only by its first entry cannot be destroyed when memory is missing
  // then (nlohmann-json 3.11.2).
  nlohmann::ordered_json options = nlohmann::ordered_json::object();     // all that decide the result, for the history
  nlohmann::ordered_json statistics = nlohmann::ordered_json::object();  // goes to --stats FILE, filled by the tool

  // The limit of a search: --time-limit, else the tool's default unless --iterations is given.
  Deadline deadline() const;
  // Prints a line on standard error: with -v, or (warn) unless -q.
  void note(const std::string& text) const;
  void warn(const std::string& text) const;
};

}  // namespace hexpipe
