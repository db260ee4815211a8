#include "common/mwis/lns_options.hpp"

#include <limits>

#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"

namespace hexpipe::mwis {

void declare_lns_options(CLI::App& app, local_search::LnsOptions& options, TargetOptions& target) {
  begin_group(app, group::experts);
  app.add_option("--fragment-size", options.fragment_size, "Number of vertices of the first fragments; the size adapts")
      ->check(whole_number_between(1, 4096).description(""));
  app.add_option("--largest-fragment", options.largest_fragment, "Greatest number of vertices of a fragment")
      ->check(whole_number_between(1, 4096).description(""));
  app.add_option("--node-limit", options.node_limit, "Greatest number of branch-and-bound nodes for a fragment")
      ->check(whole_number_between(1, 1000000000).description(""));
  app.add_option("--annealed-fragment", options.annealed_fragment,
                 "Number of vertices of the larger fragments, which are annealed; 0: no such fragments")
      ->check(whole_number_between(0, 1000000).description(""));
  app.add_option("--recombined-fragment", options.recombined_fragment,
                 "Number of vertices of fragments that are annealed from an empty set and recombined with the "
                 "solution; 0: none. Only searches of many seconds come to them; more for searches of an hour")
      ->check(whole_number_between(0, 1000000).description(""));
  app.add_option("--batch", options.batch, "Fragments per round; they are solved in parallel and applied in order")
      ->check(whole_number_between(1, 10000).description(""));
  begin_group(app, "Search");
  app.add_flag("!--no-reductions", options.reduce,
               "Search the whole graph, not the kernel that exact reductions leave");
  app.add_flag("--free-running", options.free_running,
               "Threads do not wait for each other; this is faster, but the result depends on the timing");
  app.add_option("--target-gap", target.gap,
                 "Stop when (bound - weight) / bound is at most this; certify writes the bound into the bundle")
      ->group(group::first)
      ->type_name("FRACTION")
      ->check(number_between(0, 1));
  app.add_option("--bound", target.bound, "A known upper bound, for --target-gap")
      ->type_name("WEIGHT")
      ->check(whole_number_between(0, std::numeric_limits<std::int64_t>::max()).description(""));
}

void check(const TargetOptions& target) {
  if (target.bound && !target.gap) throw UsageError("--bound does nothing without --target-gap");
}

}  // namespace hexpipe::mwis
