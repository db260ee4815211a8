#pragma once
// A fragment copied out of the graph and improved on its own, exactly or by annealing.

#include <cstdint>
#include <vector>

#include "common/mwis/exact/exact_solver.hpp"
#include "common/mwis/local_search/annealing.hpp"
#include "common/mwis/local_search/fragment.hpp"
#include "common/mwis/local_search/operator_selection.hpp"
#include "common/mwis/local_search/short_coolings.hpp"

namespace hexpipe::mwis::local_search {

// Use: begin(), grow fragment() by a FragmentGrower, extract(), solve(), then ask for the result. The memory is reused
// for the next fragment.
class FragmentSolver {
 public:
  // The operator decides how large the fragment may be.
  void begin(Operator op) { operator_ = op; }
  Operator used_operator() const { return operator_; }
  Fragment& fragment() { return fragment_; }
  const Fragment& fragment() const { return fragment_; }

  // Copies the graph of the fragment; solve needs nothing else afterwards.
  void extract(FragmentGrower& grower);
  // `budget` is the most nodes of branch and bound for the exact operator, and the kicks per vertex for the others.
  // `usual` are temperatures that suit the whole graph. `short_coolings` is a search of the whole graph, if short
  // coolings suit it: a fragment that is the whole graph continues it, others make their own.
  void solve(std::int64_t budget, Random random, const Deadline& deadline, const Cooling& usual = {},
             ShortCoolings* short_coolings = nullptr);

  // After solve(): whether the i-th of fragment().vertices is in the new set, which is not lighter than the old one.
  bool chooses(std::size_t i) const { return bits::test(chosen_.data(), i); }
  // Whether it is proven that no other set is heavier.
  bool complete() const { return complete_; }
  // The work done, roughly in nanoseconds, but counted, so that it is the same on every machine.
  double work() const { return work_; }
  // The expected work of a kick in this graph, in the same unit.
  static double work_a_kick(const graph::ConflictGraph& graph);

 private:
  void solve_exactly(std::int64_t nodes, const Deadline& deadline);
  void anneal(std::int64_t kicks_a_vertex, Random random, const Deadline& deadline, const Cooling& usual);
  void recombine(std::int64_t kicks_a_vertex, Random random, const Deadline& deadline, const Cooling& usual);
  // In about the time that so many kicks take.
  void recombine_short_coolings(std::int64_t kicks_a_vertex, const Deadline& deadline, ShortCoolings& search);
  graph::IndependentSet cool(Annealing& search, const Cooling& cooling, std::int64_t kicks_a_vertex,
                             const Deadline& deadline);
  void choose(const graph::IndependentSet& set);

  Operator operator_ = Operator::exact;
  Fragment fragment_;
  std::vector<bits::Word> chosen_;
  bool complete_ = false;
  double work_ = 0;

  ground::DenseGraph dense_;
  exact::ExactSolver solver_;
  graph::ConflictGraph sparse_;
  graph::IndependentSet start_;
};

}  // namespace hexpipe::mwis::local_search
