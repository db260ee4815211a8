#pragma once
// Runs a plan as the processes that it names.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/hexpipe/plan.hpp"

namespace hexpipe::front_door {

struct StageOutcome {
  std::string tool;
  nlohmann::ordered_json statistics;  // its --stats; null if it has none
};

struct RunOptions {
  bool quiet = false, verbose = false;
};

// Runs the pipe, then the commands behind it, and returns an outcome for each command. Messages of the tools go to
// standard error unchanged; if a pipe breaks, only the message of the first tool that failed.
//
// The first SIGINT or SIGTERM is handed on: searches end with the best so far, and the mesh is assembled from that. The
// second one ends everything.
//
// Throws DataError when a tool cannot be started, or ends with another exit code than 0; UsageError when its exit code
// is that of a bad command line.
std::vector<StageOutcome> run(const Plan& plan, const RunOptions& options);

// The result, in three lines for people.
// `assembled` is what assemble wrote by --stats; `output` names the file; `seconds` are by the clock.
std::vector<std::string> summary_of(const nlohmann::ordered_json& assembled, const std::string& output, double seconds);

}  // namespace hexpipe::front_door
