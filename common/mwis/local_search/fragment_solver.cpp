#include "common/mwis/local_search/fragment_solver.hpp"

#include <algorithm>

#include "common/mwis/local_search/recombination.hpp"

namespace hexpipe::mwis::local_search {
namespace {

// Measured on fragments of 100 to 300 vertices and of 2000, of block-28k and random-33k.
constexpr double work_a_pair = 4, work_a_node = 5000, work_a_touched_neighbour = 3;

// A fragment is heated to this share of the temperature for an empty set. 0.08, 0.15 and 0.3 mean weights were compared
// on random-33k from a solution of initsol: 0.15 gains most after 8 s, a tenth more than 0.3, which forgets the
// solution.
constexpr double reheating = 0.5;
constexpr std::int64_t cooling_steps = 50;
// A kick touches about 20 times as many neighbours as a vertex has. Beyond 64 times, a few hubs take the time.
constexpr double touched_a_kick = 20;
constexpr std::int64_t most_touched_a_kick = 64;

}  // namespace

void FragmentSolver::extract(FragmentGrower& grower) {
  if (operator_ == Operator::exact) return grower.extract(fragment_, dense_, chosen_);
  grower.sort(fragment_);
  grower.extract(fragment_, sparse_, start_);
}

void FragmentSolver::solve(std::int64_t budget, Random random, const Deadline& deadline, const Cooling& usual,
                           ShortCoolings* short_coolings) {
  if (operator_ == Operator::exact)
    solve_exactly(budget, deadline);
  else if (operator_ == Operator::anneal)
    anneal(budget, random, deadline, usual);
  else if (short_coolings == nullptr || random.below(4) == 0)  // each of both finds what the other does not
    recombine(budget, random, deadline, usual);
  else if (sparse_.vertex_count() == short_coolings->vertex_count())
    recombine_short_coolings(budget, deadline, *short_coolings);
  else {
    ShortCoolings of_fragment(sparse_, {}, random);
    recombine_short_coolings(budget, deadline, of_fragment);
  }
}

double FragmentSolver::work_a_kick(const graph::ConflictGraph& graph) {
  const auto directed_edges = static_cast<double>(graph.neighbours.size());
  return work_a_touched_neighbour * touched_a_kick * directed_edges / std::max(1, graph.vertex_count());
}

void FragmentSolver::solve_exactly(std::int64_t nodes, const Deadline& deadline) {
  const auto size = static_cast<double>(dense_.size());
  ground::SearchBudget budget(nodes, &deadline);
  complete_ = solver_.solve(dense_, chosen_, budget);
  work_ = work_a_pair * size * size + work_a_node * static_cast<double>(budget.spent());
}

void FragmentSolver::anneal(std::int64_t kicks_a_vertex, Random random, const Deadline& deadline,
                            const Cooling& usual) {
  Annealing search(sparse_, start_, random);
  choose(cool(search, {.hot = reheating * usual.hot, .cold = usual.cold}, kicks_a_vertex, deadline));
}

// Two unrelated sets differ everywhere, and each is the better one in places.
void FragmentSolver::recombine(std::int64_t kicks_a_vertex, Random random, const Deadline& deadline,
                               const Cooling& usual) {
  Annealing search(sparse_, {}, random);
  choose(hexpipe::mwis::local_search::recombine(sparse_, start_, cool(search, usual, kicks_a_vertex, deadline)));
}

void FragmentSolver::recombine_short_coolings(std::int64_t kicks_a_vertex, const Deadline& deadline,
                                              ShortCoolings& search) {
  const double before = search.touched();
  const double kicks = static_cast<double>(kicks_a_vertex) * sparse_.vertex_count();
  search.run(kicks * work_a_kick(sparse_) / work_a_touched_neighbour, deadline);
  work_ = work_a_touched_neighbour * (search.touched() - before);
  choose(hexpipe::mwis::local_search::recombine(sparse_, start_, search.best()));
}

graph::IndependentSet FragmentSolver::cool(Annealing& search, const Cooling& cooling, std::int64_t kicks_a_vertex,
                                           const Deadline& deadline) {
  const double unit = search.mean_weight();
  const std::int64_t kicks = kicks_a_vertex * sparse_.vertex_count();
  const auto directed_edges = static_cast<std::int64_t>(sparse_.neighbours.size());
  const std::int64_t most_touched = most_touched_a_kick * kicks_a_vertex * directed_edges / cooling_steps;
  for (std::int64_t step = 0; step < cooling_steps; ++step) {
    const double progress = static_cast<double>(step) / static_cast<double>(cooling_steps);
    search.run(kicks * (step + 1) / cooling_steps - kicks * step / cooling_steps, unit * cooling.at(progress), deadline,
               most_touched);
  }
  work_ = work_a_touched_neighbour * static_cast<double>(search.touched());
  return search.best();
}

void FragmentSolver::choose(const graph::IndependentSet& set) {
  chosen_.assign(bits::words_for(sparse_.weights.size()), 0);
  for (const std::int32_t i : set) bits::insert(chosen_.data(), static_cast<std::size_t>(i));
  complete_ = false;
}

}  // namespace hexpipe::mwis::local_search
