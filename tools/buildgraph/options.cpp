#include "tools/buildgraph/options.hpp"

#include "common/run/error.hpp"

namespace hexpipe::buildgraph {

void check(const BuildgraphOptions& options, bool to_bundle) {
  if (options.conflicts.share.count > 1 && (options.reduce || options.cover))
    throw UsageError("--part does not go with --reduce and --cover: they need the whole graph");
  if (options.quad_reward > 0 && (options.conflicts.share.count > 1 || options.reduce))
    throw UsageError("--quad-reward does not go with --part and --reduce: it needs all candidates and conflicts");
  if (!options.reduce && !options.reduced_candidates.empty())
    throw UsageError("--reduced-candidates does nothing without --reduce");
  if (options.reduce && !to_bundle && options.reduced_candidates.empty())
    throw UsageError("--reduce to a .graph needs --reduced-candidates FILE: its lines are the graph's vertices");
  if (options.cover && !to_bundle) throw UsageError("--cover needs a bundle to be written to: a .tar, or a pipe");
}

}  // namespace hexpipe::buildgraph
