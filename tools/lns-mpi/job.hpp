#pragma once
// A whole run of lns-mpi on one of its ranks: read, search in rounds with checkpoints, write.

#include <string>
#include <vector>

#include "common/mwis/lns_options.hpp"
#include "common/run/run_context.hpp"
#include "tools/lns-mpi/ranks.hpp"
#include "tools/lns-mpi/rounds.hpp"

namespace hexpipe::lns_mpi {

struct JobOptions {
  RoundsOptions rounds;
  double target_gap = -1;         // below 0: none
  std::int64_t known_bound = -1;  // likewise
  std::int32_t blocks = 0;        // of a graph that is read whole; 0: as many as its size asks for
  std::int32_t overlap = 2;
  std::int64_t passes = 0;           // of the dual, for a bound that is proven when the search has ended
  std::string certificate;           // a file for its proof; empty: none
  std::string fragments;             // a file for those that were improved; empty: none
  std::vector<std::string> parts;    // bundles of a graph that is not
  std::string checkpoint;            // a directory; empty: none
  double checkpoint_interval = 600;  // seconds
};

// Throws ErrorOfAll on all ranks where one cannot go on.
void run_job(Ranks& ranks, RunContext& context, JobOptions options);

}  // namespace hexpipe::lns_mpi
