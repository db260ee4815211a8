#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <optional>

#include "common/mwis/lns_options.hpp"
#include "common/run/memory.hpp"
#include "common/run/messages.hpp"
#include "common/run/muted_cout.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "tools/lns-mpi/job.hpp"

using namespace hexpipe;
using namespace hexpipe::lns_mpi;

namespace {

// Without memory the libraries that start MPI end the process in their own words and with their own exit codes. Those
// of Open MPI 5 take 34 MiB.
constexpr std::uint64_t bytes_to_start = 40 << 20;

// An error that all ranks throw together ends them one by one; any other error ends all of them at once.
void run_on_all_ranks(RunContext& context, const LnsMpiOptions& options) {
  expect_memory(1, bytes_to_start, "MPI");
  Ranks ranks;
  try {
    run_job(ranks, context, options);
  } catch (const ErrorOfAll& error) {
    // The first rank that ends with an error makes mpirun end the others, so all wait until one of them has said why.
    print_message(context.info.name, error.what());
    ranks.together([] {});
    silence_messages(true);
    if (error.of_usage()) throw UsageError(error.what());
    throw DataError(error.what());
  } catch (const std::exception& error) {
    silence_messages(false);
    print_message(context.info.name, fmt::format("rank {}: {}", ranks.rank(), error.what()));
    Ranks::abandon();
  }
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "lns-mpi",
      .summary = "Improve a choice of candidates on many machines, as lns does on one.",
      .example = "mpirun -n 4 lns-mpi --graph part.graph --solution part.sol --time-limit 60 -o better.sol",
      .reads = {Role::graph, Role::solution},
      .product = Role::solution,
      .random = true,
      .searches = true,
      .default_time_limit = 60};
  LnsMpiOptions options;
  mwis::TargetOptions target;
  CLI::Option* round = nullptr;
  const auto declare = [&](CLI::App& app) {
    mwis::declare_lns_options(app, options.rounds.search, target);
    begin_group(app, "Blocks");
    app.add_option("--blocks", options.blocks,
                   "Blocks to cut the graph into, at least one for each rank; 0: one for each 50000 vertices, and "
                   "without --iterations the same number for each rank")
        ->check(whole_number_between(0, 1000000).description(""));
    app.add_option("--overlap", options.overlap,
                   "How many edges beyond its border a block may change the solution; 0: 2, but without --iterations 1 "
                   "where a rank has less than 20000 vertices")
        ->check(whole_number_between(0, 16).description(""));
    round = app.add_option("--round", options.rounds.fragments_a_round,
                           "Fragments of a round for each thousand vertices, with --iterations");
    round->check(whole_number_between(1, 1000000).description(""));
    begin_group(app, "Proof");
    CLI::Option* const prove = app.add_option(
        "--prove", options.passes, "Prove a bound after the search, in this many passes of the dual; 0: no bound");
    prove->check(whole_number_between(0, 1000000).description(""));
    outside_history(app.add_option("--certificate", options.certificate,
                                   "Write the proof to a file, as certify does; for a graph that is not in parts"))
        ->type_name("FILE")
        ->needs(prove);
    outside_history(
        app.add_option("--fragments", options.fragments,
                       "Write the improved fragments to a file, as lns does; for a graph that is not in parts"))
        ->group(group::output)
        ->type_name("FILE");
    outside_history(
        app.add_option(
            "--parts", options.parts,
            "Bundles of the parts of a graph, in their order; the solution goes into bundles of the same names in the "
            "directory that -o names"))
        ->group(group::first)
        ->type_name("FILE");
    begin_group(app, "Checkpoints");
    CLI::Option* const checkpoint =
        outside_history(
            app.add_option("--checkpoint", options.checkpoint,
                           "Keep the state of the search in this directory, and go on from the state that is there"))
            ->type_name("DIR");
    outside_history(
        app.add_option("--checkpoint-interval", options.checkpoint_interval, "Seconds from one checkpoint to the next"))
        ->check(number_between(0, 1e9))
        ->needs(checkpoint);
  };
  const auto run = [&](RunContext& context) {
    mwis::check(target);
    check(options, round->count() > 0, context);
    options.rounds.search.seed = context.common.seed;
    options.rounds.search.iterations = context.common.iterations.value_or(options.rounds.search.iterations);
    options.target_gap = target.gap;
    options.known_bound = target.bound;
    // mpirun gives standard output as a terminal that leaves bytes as they are, and nobody sits at it.
    if (launched_rank() && writes_standard_output(context)) context.streams.output = "/dev/stdout";
    run_on_all_ranks(context, options);
  };
  const bool is_silent = launched_rank().value_or(0) > 0;
  std::optional<MutedCout> muted;
  if (is_silent) {
    silence_messages(true);
    muted.emplace();
  }
  // mpirun passes this signal on to its processes; after SIGTERM, it ends them within a second.
  stop_searches_also_on(SIGUSR1);
  const int code = tool_main(argc, argv, info, declare, run);
  if (code == 0 || !is_silent || Ranks::were_started()) return code;
  // What is wrong with the options, each rank finds by itself, and the first one that ends makes mpirun end the others.
  // So the silent ones wait for it. Whom mpirun does not end meanwhile is alone with it, and says it.
  constexpr unsigned seconds_for_the_first_rank = 5;
  if (sleep(seconds_for_the_first_rank) != 0) return code;
  silence_messages(false);
  return tool_main(argc, argv, info, declare, run);
}
