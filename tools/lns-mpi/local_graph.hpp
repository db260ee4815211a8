#pragma once
// The part of a conflict graph that one rank holds, when the graph is cut into blocks: the rank's own blocks and a halo
// around them. It has the rows of all vertices at most `overlap` edges away from a block of its own, and the solution
// there and one edge further.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

// The rows of the vertices that a rank owns: what it begins with. A vertex's key is its number in the whole graph.
// Arrays have an entry for each vertex; the row of vertex v is neighbours[offsets[v]] up to, but without,
// neighbours[offsets[v + 1]].
struct OwnedRows {
  std::vector<std::uint64_t> keys;  // ascending
  std::vector<std::int32_t> blocks;
  std::vector<std::int64_t> weights;
  std::vector<std::uint8_t> chosen;
  std::vector<std::int64_t> offsets{0};
  std::vector<std::uint64_t> neighbours;       // ascending within a row
  std::vector<std::int32_t> neighbour_blocks;  // of each neighbour
};

// Which rank has which blocks: consecutive ones, in numbers as even as possible.
class BlockOwners {
 public:
  BlockOwners(std::int32_t blocks, int ranks) : blocks_(blocks), ranks_(ranks) {}
  std::int32_t blocks() const { return blocks_; }
  int ranks() const { return ranks_; }
  std::int32_t first_of(int rank) const {
    return static_cast<std::int32_t>(static_cast<std::int64_t>(blocks_) * rank / ranks_);
  }
  int rank_of(std::int32_t block) const {
    return static_cast<int>((static_cast<std::int64_t>(block + 1) * ranks_ - 1) / blocks_);
  }

 private:
  std::int32_t blocks_;
  int ranks_;
};

// Another block that is near a vertex, and how many edges away it begins.
struct NearBlock {
  std::int32_t block, distance;
};

// Vertices here are numbered in the order of their keys.
struct LocalGraph {
  BlockOwners owners{1, 1};
  int rank = 0;
  std::int32_t overlap = 0;
  std::vector<std::uint64_t> keys;
  graph::ConflictGraph graph;  // empty rows where only the solution is held
  std::vector<std::int32_t> block;
  std::vector<std::int64_t> near_offsets{0};
  std::vector<NearBlock> near;  // other blocks at most overlap + 1 edges away, ascending
  std::vector<std::uint8_t> chosen;
  // By vertex: reductions took it or left it out for good before the search; no region has it.
  std::vector<std::uint8_t> decided;

  // A rank that holds some of the same vertices, and has the same list of them.
  struct Partner {
    int rank;
    std::vector<std::int32_t> shared;
  };
  std::vector<Partner> partners;

  std::int32_t vertex_count() const { return graph.vertex_count(); }
  bool owns(std::int32_t v) const { return owners.rank_of(block[v]) == rank; }
  std::span<const NearBlock> near_of(std::int32_t v) const {
    return std::span(near).subspan(near_offsets[v], near_offsets[v + 1] - near_offsets[v]);
  }
};

// Sends every rank the rows and solution of its halo. Each row travels once to each rank that holds it.
LocalGraph make_local_graph(Ranks& ranks, const BlockOwners& owners, OwnedRows rows, std::int32_t overlap);

// Two checks, by sums of hashes, which do not depend on which rank holds what: all ranks hold parts of one graph, and a
// checkpoint belongs to the same graph.
//
// The fingerprint of vertices, weights, edges and blocks of all ranks together.
std::uint64_t fingerprint_of(Ranks& ranks, const OwnedRows& rows);

// Throws DataError on all ranks when an edge between two blocks is in the rows of only one of its ends; the message
// names the blocks.
void expect_agreement(Ranks& ranks, const BlockOwners& owners, const OwnedRows& rows);

}  // namespace hexpipe::lns_mpi
