#pragma once
// Decides where each block may change the solution in a round. Each round has an order of the blocks. A block takes the
// vertices that are at most `overlap` edges away from it and that no earlier block takes. So borders move from round to
// round, and none stays where it is. Where an edge joins vertices of two blocks, the vertex of the later block stays as
// it is. Then all blocks can be searched at the same time.
//
// A rank may also search its blocks as one. Then no vertex has to stay between two of them. The order is still one of
// blocks, so that one part of the border between two ranks moves to one side and another part to the other.

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

// Which blocks are searched as one, and which rank does it.
class Searchers {
 public:
  enum class Kind { blocks, ranks };
  Searchers(const BlockOwners& owners, Kind kind) : owners_(owners), kind_(kind) {}

  std::int32_t count() const { return kind_ == Kind::blocks ? owners_.blocks() : owners_.ranks(); }
  std::int32_t of_block(std::int32_t block) const { return kind_ == Kind::blocks ? block : owners_.rank_of(block); }
  // Those of a rank are consecutive.
  std::int32_t first_of(int rank) const { return kind_ == Kind::blocks ? owners_.first_of(rank) : rank; }

 private:
  BlockOwners owners_;
  Kind kind_;
};

class Regions {
 public:
  // Every rank draws the same order: it depends on the seed and the round alone.
  Regions(const LocalGraph& local, const Searchers& searchers, std::uint64_t seed, std::int64_t round);

  // The region of one of the rank's own searchers.
  Region extract(std::int32_t searcher);

 private:
  bool stays(std::int32_t v) const;
  bool is_blocked(std::int32_t v) const;

  const LocalGraph& local_;
  std::int32_t first_own_;
  Searchers searchers_;
  std::vector<std::uint64_t> priority_;                // of each block, all different
  std::vector<std::int32_t> block_;                    // of each vertex, in this round
  std::vector<std::vector<std::int32_t>> may_change_;  // by searcher of the rank's own
  std::vector<std::int32_t> number_;                   // by vertex: its number in the region that is extracted
};

}  // namespace hexpipe::lns_mpi
