#include "common/mwis/exact_algorithm.hpp"

#include <cassert>

#include "common/mwis/branch_and_reduce.hpp"
#include "common/mwis/clique_dual.hpp"
#ifdef HEXPIPE_WITH_CLP
#include "common/mwis/cutting_planes.hpp"
#endif

namespace hexpipe {

const std::map<std::string, ExactAlgorithm>& exact_algorithms() {
  static const std::map<std::string, ExactAlgorithm> algorithms{
      {"branch-and-reduce", ExactAlgorithm::branch_and_reduce},
#ifdef HEXPIPE_WITH_CLP
      {"branch-and-cut", ExactAlgorithm::branch_and_cut},
#endif
  };
  return algorithms;
}

std::string default_exact_algorithm() {
  return exact_algorithms().contains("branch-and-cut") ? "branch-and-cut" : "branch-and-reduce";
}

Relax relaxation_of(ExactAlgorithm algorithm) {
#ifdef HEXPIPE_WITH_CLP
  if (algorithm == ExactAlgorithm::branch_and_cut) return relax_by_cutting_planes;
#endif
  assert(algorithm == ExactAlgorithm::branch_and_reduce);
  return relax_by_clique_dual;
}

ExactResult solve_exactly(const ConflictGraph& graph, std::int64_t weight, ExactAlgorithm algorithm,
                          const Deadline& deadline) {
  BranchAndReduce search(relaxation_of(algorithm), deadline);
  ExactResult result;
  result.better = search.solve(graph, weight);
  result.complete = search.complete();
  result.bound = search.bound();
  result.nodes = search.nodes();
  return result;
}

}  // namespace hexpipe
