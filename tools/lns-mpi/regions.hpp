#pragma once
// Decides where each block may change the solution in a round. Each round draws a new order of the blocks. A block
// takes the vertices that are at most `overlap` edges away from it and that no earlier block takes, so that borders
// move to and fro and leave no seam. Where an edge joins vertices of two blocks, the vertex of the later block stays as
// it is; then all blocks can be searched at the same time.

#include <cstdint>
#include <vector>

#include "tools/lns-mpi/local_graph.hpp"

namespace hexpipe::lns_mpi {

// The vertices that may be chosen in a region while everything around it stays.
struct Region {
  std::vector<std::int32_t> vertices;  // of the local graph, ascending
  graph::ConflictGraph graph;          // of these, numbered in this order
  graph::IndependentSet chosen;
};

class Regions {
 public:
  // Every rank draws the same order.
  Regions(const LocalGraph& local, std::uint64_t seed, std::int64_t round);

  // The region of one of the rank's own blocks.
  Region extract(std::int32_t block);

 private:
  bool stays(std::int32_t v) const;
  bool is_blocked(std::int32_t v) const;

  const LocalGraph& local_;
  std::vector<std::uint64_t> priority_;                // of each block, all different
  std::vector<std::int32_t> block_;                    // of each vertex, in this round
  std::vector<std::vector<std::int32_t>> may_change_;  // by block of the rank's own
  std::vector<std::int32_t> number_;                   // by vertex: its number in the region that is extracted
};

}  // namespace hexpipe::lns_mpi
