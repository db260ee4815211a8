#pragma once
// A quick upper bound: a greedy clique cover (Verhetsel 2017, 3.2, algorithm 3) counts each clique by its heaviest
// vertex.

#include <cstdint>
#include <vector>

#include "common/mwis/ground/dense_graph.hpp"

namespace hexpipe::mwis::bounds {

class CliqueCoverBound {
 public:
  // True if a cover proves that no independent set within `set` (of graph.words() words) is heavier than `limit`; false
  // as soon as that is out of reach. Empties `set`.
  bool at_most(const ground::DenseGraph& graph, bits::Word* set, std::int64_t limit);

 private:
  std::vector<bits::Word> clique_;
};

}  // namespace hexpipe::mwis::bounds
