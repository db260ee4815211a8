#pragma once
// The frame of every tool: common options, signals, --stats, and the mapping of errors to messages and exit codes (0
// done, 1 bad data or failed I/O, 2 bad command line).

#include <CLI/CLI.hpp>
#include <functional>

#include "common/run/run_context.hpp"

namespace hexpipe {

// main() of a tool: `declare` adds the tool's own options, `run` does the work. Returns the exit code.
int tool_main(int argc, char** argv, const ToolInfo& info, const std::function<void(CLI::App&)>& declare,
              const std::function<void(RunContext&)>& run);

}  // namespace hexpipe
