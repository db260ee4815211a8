#pragma once
// A fragment taken out of the graph and improved on its own, exactly or by annealing.

#include <cstdint>
#include <vector>

#include "common/mwis/exact/exact_solver.hpp"
#include "common/mwis/local_search/annealing.hpp"
#include "common/mwis/local_search/effort.hpp"
#include "common/mwis/local_search/fragment.hpp"

namespace hexpipe::mwis::local_search {

// Keeps its memory from one fragment to the next.
class Repair {
 public:
  // The way decides how large the fragment may be, so it comes first.
  void begin(Way way) { way_ = way; }
  Way way() const { return way_; }
  Fragment& fragment() { return fragment_; }
  const Fragment& fragment() const { return fragment_; }

  // Copies the graph of the fragment, after which solve needs nothing else.
  void extract(FragmentGrower& grower);
  // Exactly: with so many nodes of branch and bound at most; otherwise with so many kicks a vertex, and at
  // temperatures that suit the whole graph.
  void solve(std::int64_t effort, Random random, const Deadline& deadline, const Cooling& usual = {});

  // After solve: by place in fragment().vertices, a set that is not lighter.
  bool chooses(std::size_t i) const { return bits::test(chosen_.data(), i); }
  // It is proven that no other one is heavier.
  bool complete() const { return complete_; }
  // A rough number of nanoseconds that does not depend on the machine.
  double work() const { return work_; }
  // What a kick will take in this graph, likewise.
  static double work_a_kick(const graph::ConflictGraph& graph);

 private:
  void solve_exactly(std::int64_t nodes, const Deadline& deadline);
  void anneal(std::int64_t kicks_a_vertex, Random random, const Deadline& deadline, const Cooling& usual);
  void recombine(std::int64_t kicks_a_vertex, Random random, const Deadline& deadline, const Cooling& usual);
  graph::IndependentSet cool(Annealing& search, const Cooling& cooling, std::int64_t kicks_a_vertex,
                             const Deadline& deadline);
  void choose(const graph::IndependentSet& set);

  Way way_ = Way::exact;
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
