#pragma once
// Branch and bound by LP-Clique (Verhetsel 2017, 3.2, algorithm 5): the linear relaxation with a row for each clique of
// a greedy edge clique cover. Its dual is solved by subgradient steps (Held, Wolfe, Crowder 1974) that start from the
// prices of the parent node. Reduced costs drop candidates and choose the vertex to branch on. Prices are whole
// multiples of a small fraction of a weight, so bounds are exact.

#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/mwis/exact/bit_search.hpp"

namespace hexpipe::mwis::exact::historical {

class SubgradientSearch : public BitSearch {
 public:
  SubgradientSearch() : BitSearch(1) {}

  // The same contract as BranchAndBound::solve. `cover` is an edge clique cover of the graph; the weights sum to less
  // than 2^58.
  bool solve(const ground::DenseGraph& graph, const graph::CliqueCover& cover, std::int64_t lower_bound,
             ground::SearchBudget& budget);

 private:
  using Prices = std::vector<std::int64_t>;

  void expand(std::size_t depth, std::int64_t weight, Prices prices);
  bool improve(std::size_t depth, std::int64_t needed, Prices& prices);
  std::int64_t bound(std::size_t depth, const Prices& prices);
  void step(double length, Prices& prices);
  std::size_t highest_cost(std::size_t depth);

  int shift_ = 0;                    // prices and costs are whole multiples of 2^-shift_ of a weight
  std::vector<std::int64_t> costs_;  // of the candidates, beyond the prices of their cliques
  std::vector<int> chosen_;          // by clique: candidates of positive cost
  std::vector<std::vector<std::int32_t>> cliques_of_;
};

}  // namespace hexpipe::mwis::exact::historical
