#pragma once
// A whole run of lns-mpi, as each of its ranks makes it: read, search in rounds with checkpoints, write.

#include "common/run/run_context.hpp"
#include "tools/lns-mpi/options.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

// Throws ErrorOfAll on all ranks when one of them cannot go on.
void run_job(Ranks& ranks, RunContext& context, const LnsMpiOptions& options);

}  // namespace hexpipe::lns_mpi
