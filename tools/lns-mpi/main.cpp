#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>

#include "common/mwis/search_log.hpp"
#include "common/mwis/target_weight.hpp"
#include "common/run/lns_options.hpp"
#include "common/run/messages.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/stage.hpp"
#include "tools/lns-mpi/cut.hpp"
#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"
#include "tools/lns-mpi/rounds.hpp"
#include "tools/lns-mpi/whole_graph.hpp"

using namespace hexpipe;

namespace {

// Of a graph that is cut here when the number is not given: regions large enough for the search to have room.
std::int32_t usual_blocks(std::int64_t vertices) {
  constexpr std::int64_t least = 4, most = 1 << 20, vertices_a_block = 50000;
  return static_cast<std::int32_t>(std::clamp(vertices / vertices_a_block, least, most));
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
  RoundsOptions options;
  TargetOptions target;
  std::int32_t blocks = 0, overlap = 2;
  const auto declare = [&](CLI::App& app) {
    declare_lns_options(app, options.search, target);
    app.add_option("--blocks", blocks, "Blocks to cut the graph into, at least one a rank; 0: one for 50000 vertices")
        ->check(CLI::Range(0, 1000000).description(""));
    app.add_option("--overlap", overlap, "How many edges beyond its border a block may change the solution")
        ->check(CLI::Range(1, 16).description(""));
    app.add_option("--round", options.fragments_a_round,
                   "Fragments in a round for a thousand vertices, under a limit of iterations")
        ->check(CLI::Range(1, 1000000).description(""));
  };
  const auto run = [&](RunContext& context) {
    check(target);
    options.search.seed = context.common.seed;
    options.search.iterations = context.common.iterations.value_or(options.search.iterations);
    // mpirun gives standard output as a terminal that leaves bytes as they are, and nobody sits at it.
    if (launched_rank() && (context.streams.output.empty() || context.streams.output == "-"))
      context.streams.output = "/dev/stdout";
    Ranks ranks;
    std::optional<Stage> stage;
    std::optional<SearchLog> log;
    const Deadline deadline = context.deadline();
    OwnedRows rows;
    std::vector<std::int32_t> cut;
    StageData data;
    ranks.together([&] {
      if (!ranks.is_first()) return;
      stage.emplace(context);
      log.emplace(context.common.log_file);
      data = stage->read({Role::graph, Role::solution});
      if (blocks == 0) blocks = usual_blocks(data.graph->vertex_count());
      if (blocks < ranks.count())
        throw DataError(fmt::format("expected at least a block for each of {} ranks, found {}", ranks.count(), blocks));
      cut = cut_into_blocks(*data.graph, blocks);
      if (target.gap)
        options.search.target = target_weight(*target.gap, target.bound ? target.bound : bound_in(data.history));
    });
    Packer facts;
    facts.put(blocks);
    facts.put(options.search.target);
    Bytes bytes = facts.take();
    ranks.broadcast(bytes);
    Unpacker unpacker(bytes);
    blocks = unpacker.get<std::int32_t>();
    options.search.target = unpacker.get<std::int64_t>();
    const BlockOwners owners(blocks, ranks.count());
    rows = ranks.is_first() ? scatter_rows(ranks, owners, *data.graph, *data.solution, cut) : receive_rows(ranks);
    Piece piece = make_piece(ranks, owners, std::move(rows), overlap);

    RoundsProgress progress;
    progress.weight = total_weight(ranks, piece);
    const std::int64_t weight_before = progress.weight;
    Progress shown("lns-mpi", context.common.quiet || !ranks.is_first());
    improve_in_rounds(
        ranks, piece, options, deadline, progress, [&](const RoundsProgress& now, const RoundCosts& costs) {
          if (log) log->record(deadline.elapsed(), now.iterations, now.weight);
          if (shown.due()) shown.show(fmt::format("weight {} after {} rounds", now.weight, now.round));
          context.note(
              fmt::format("rank {} round {}: weight {}, {:.2f} s of search, {:.2f} s of waiting, {} messages, {} bytes",
                          ranks.rank(), now.round, now.weight, costs.search_seconds, costs.wait_seconds,
                          costs.traffic.messages, costs.traffic.bytes));
          return true;
        });
    const IndependentSet solution = gather_solution(ranks, piece);
    ranks.together([&] {
      if (!ranks.is_first()) return;
      log->finish(deadline.elapsed(), progress.iterations, progress.weight);
      context.note(fmt::format("{} chosen, weight {} after {} rounds, {} before", solution.size(), progress.weight,
                               progress.round, weight_before));
      context.statistics["weight"] = progress.weight;
      context.statistics["chosen"] = solution.size();
      context.statistics["iterations"] = progress.iterations;
      context.statistics["improvements"] = progress.improvements;
      stage->write(solution,
                   {{"weight", progress.weight}, {"iterations", progress.iterations}, {"rounds", progress.round}});
    });
  };
  if (launched_rank().value_or(0) > 0) {
    silence_messages(true);
    std::cout.setstate(std::ios::failbit);
  }
  return tool_main(argc, argv, info, declare, run);
}
