#pragma once
// The options of the search that lns and lns-mpi share.

#include <CLI/CLI.hpp>
#include <optional>

#include "common/mwis/local_search/lns.hpp"

namespace hexpipe::mwis {

struct TargetOptions {
  std::optional<double> gap;
  std::optional<std::int64_t> bound;
};

void declare_lns_options(CLI::App& app, local_search::LnsOptions& options, TargetOptions& target);

// Throws UsageError for options that have no effect without another one.
void check(const TargetOptions& target);

}  // namespace hexpipe::mwis
