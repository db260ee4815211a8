#pragma once
// Runs a plan as the processes that it names.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/hexpipe/plan.hpp"

namespace hexpipe::front_door {

struct StageOutcome {
  std::string tool;
  nlohmann::ordered_json statistics;  // what it wrote by --stats; null where it has none
};

struct RunOptions {
  bool quiet = false, verbose = false;
};

// Runs the pipe, then what comes behind it, and returns an outcome for each command. Messages of the tools come through
// on standard error as they are; of a pipe that breaks, only what the first tool that failed has to say.
//
// The first SIGINT or SIGTERM is handed on: searches end with the best so far, and the mesh is assembled from that. The
// second ends everything.
//
// Throws DataError when a tool cannot be started, or ends with another exit code than 0; UsageError when its exit code
// is that of a bad command line.
std::vector<StageOutcome> run(const Plan& plan, const RunOptions& options);

}  // namespace hexpipe::front_door
