#pragma once
// Where each block may change the solution in a round. Blocks are drawn an order anew for each round, and each takes
// what is at most `overlap` edges away from it and from none that comes before: so borders move to and fro across the
// old ones and leave no seam. Of two vertices with an edge between them that belong to different blocks, the one of the
// later block stays as it is; then all blocks can be searched at the same time.

#include <cstdint>
#include <vector>

#include "tools/lns-mpi/piece.hpp"

namespace hexpipe::lns_mpi {

// What can be chosen in a region while everything around it stays.
struct Region {
  std::vector<std::int32_t> vertices;  // of the piece, ascending
  graph::ConflictGraph graph;          // of these, numbered in this order
  graph::IndependentSet chosen;
  std::vector<char> at_edge;  // has a neighbour that another region may change, in this round or in another one
};

class Regions {
 public:
  // Every rank draws the same order.
  Regions(const Piece& piece, std::uint64_t seed, std::int64_t round);

  // The block that may change a vertex of the piece, whether or not it stays for the sake of a neighbour.
  std::int32_t block_at(std::int32_t v) const { return block_[v]; }

  // Of a block of the rank's own.
  Region extract(std::int32_t block);

 private:
  bool stays(std::int32_t v) const;
  bool is_blocked(std::int32_t v) const;

  const Piece& piece_;
  std::vector<std::uint64_t> priority_;                // of each block, all different
  std::vector<std::int32_t> block_;                    // of each vertex, in this round
  std::vector<std::vector<std::int32_t>> may_change_;  // by block of the rank's own
  std::vector<std::int32_t> number_;                   // in the region that is extracted
};

}  // namespace hexpipe::lns_mpi
