
#include <utility>

#include "common/mwis/exact/heavy_cliques.hpp"
#include "common/mwis/exact/packing_program.hpp"

namespace hexpipe::mwis::exact {
namespace {

// Rounds of adding cliques: before the first branch, and in a node, where branches do the work of later rounds.
constexpr int root_rounds = 100, node_rounds = 5;

}  // namespace

bounds::Relaxation relax_by_cutting_planes(const graph::ConflictGraph& graph, std::int64_t target, int depth,
                                           const Deadline& deadline) {
  graph::CliqueCover cover = graph::greedy_edge_clique_cover(graph);
  PackingProgram program(graph.weights);
  HeavyCliques heavy_cliques(graph);
  std::int64_t rows = 0;
  bounds::Relaxation best;
  for (int rounds = depth == 0 ? root_rounds : node_rounds; rounds > 0; --rounds) {
    for (; rows < cover.size(); ++rows) program.add_row(cover.clique(rows));
    const bool optimal = program.solve(deadline);
    bounds::Relaxation now = bounds::bounds_of_prices(graph, cover, program.prices());
    now.fractions = program.fractions();
    if (rows == 0 || now.bound <= best.bound || best.fractions.empty()) best = std::move(now);
    if (!optimal || best.bound <= target || heavy_cliques.add(program.fractions(), cover) == 0) break;
  }
  return best;
}

}  // namespace hexpipe::mwis::exact
