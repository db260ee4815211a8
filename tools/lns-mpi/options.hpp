#pragma once
// The command line of lns-mpi as values.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/run/run_context.hpp"
#include "tools/lns-mpi/rounds.hpp"

namespace hexpipe::lns_mpi {

struct LnsMpiOptions {
  RoundsOptions rounds;
  std::optional<double> target_gap;
  std::optional<std::int64_t> known_bound;
  std::int32_t blocks = 0;           // of a graph that is read whole; 0: as many as its size asks for
  std::int32_t overlap = 0;          // 0: as the size of the blocks and the kind of limit ask for
  std::int64_t passes = 0;           // of the dual, for a bound that is proven after the search; 0: no proof
  std::string certificate;           // a file for the proof; empty: no such file
  std::string fragments;             // a file for the improved fragments; empty: no such file
  std::vector<std::string> parts;    // bundles of a graph in parts; empty: the graph is read whole
  std::string checkpoint;            // a directory; empty: no checkpoints
  double checkpoint_interval = 600;  // seconds
};

// Throws UsageError where options exclude each other, have no effect without others, or do not go with a graph in
// parts.
void check(const LnsMpiOptions& options, bool round_is_given, const RunContext& context);

bool writes_standard_output(const RunContext& context);

}  // namespace hexpipe::lns_mpi
