#pragma once
// Cliques whose fractional values sum to more than 1; they tighten a linear relaxation. Each is the heaviest around its
// first vertex. Branch and bound on the complement of the fractional neighbourhood finds it, and then it is grown until
// it is maximal (the separation of clique inequalities, Nemhauser and Sigismondi 1992, solved exactly).

#include <cstdint>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/mwis/exact/branch_and_bound.hpp"

namespace hexpipe::mwis::exact {

class HeavyCliques {
 public:
  explicit HeavyCliques(const graph::ConflictGraph& graph)
      : graph_(graph), in_support_(graph.weights.size(), 0), found_(graph.weights.size(), 0) {}

  // Adds some of these cliques to `cover`, at least one if there is any within reach of the search around each vertex.
  // Returns their number.
  std::int64_t add(const std::vector<double>& fractions, graph::CliqueCover& cover);

 private:
  bool find_around(std::int32_t v);
  void make_complement();
  void make_maximal();

  const graph::ConflictGraph& graph_;
  const std::vector<double>* fractions_ = nullptr;
  std::vector<char> in_support_;
  std::vector<int> found_;  // by vertex: cliques of this call that contain it
  std::vector<std::int32_t> around_, clique_;
  ground::DenseGraph complement_;
  BranchAndBound branch_and_bound_;
};

}  // namespace hexpipe::mwis::exact
