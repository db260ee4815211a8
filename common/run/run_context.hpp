#pragma once
// The description of a tool, and the arguments of its run function.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/run/deadline.hpp"
#include "common/run/stream_options.hpp"

namespace hexpipe {

// The version of hexpipe, "major.minor.patch".
const char* version();

struct ToolInfo {
  std::string name;
  std::string summary;          // one sentence
  std::string example;          // a worked example for --help
  std::vector<Role> reads;      // roles that may come from files; the first one is that of a plain operand
  std::optional<Role> product;  // what -o FILE writes; nothing: the tool writes no stream
  bool random = false;          // has --seed
  bool searches = false;        // has --time-limit, --iterations and --log, and ends gracefully on signals
  std::optional<double> default_time_limit{};  // seconds, for a search without --time-limit and --iterations
  std::string ends_by_itself{};                // or the condition that ends such a search
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

// The argument of a tool's run function.
struct RunContext {
  ToolInfo info;
  CommonOptions common;
  StreamOptions streams;
  // These are objects from the start. nlohmann-json 3.11.2 cannot destroy one that becomes an object by its first entry
  // when memory is exhausted at that moment.
  nlohmann::ordered_json options = nlohmann::ordered_json::object();     // all that decide the result; for the history
  nlohmann::ordered_json statistics = nlohmann::ordered_json::object();  // the tool fills it; it goes to --stats FILE

  // The limit of a search: --time-limit, or the tool's default unless --iterations is given.
  Deadline deadline() const;
  // Prints a line on standard error: note() with -v, warn() unless -q.
  void note(const std::string& text) const;
  void warn(const std::string& text) const;
};

}  // namespace hexpipe
