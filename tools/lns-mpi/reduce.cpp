// Quick reductions take a vertex or leave out a neighbour of it, for reasons that lie in the neighbourhood of one
// vertex. Where that neighbourhood is in one block, decisions of other blocks at the same time do not change the
// reason. So blocks need not hear of each other until all are done, and the result does not depend on the number of
// ranks.
#include "tools/lns-mpi/reduce.hpp"

#include <algorithm>

#include "common/mwis/reduce/reducer.hpp"

namespace hexpipe::lns_mpi {
namespace {

struct BlockGraph {
  std::vector<std::int32_t> vertices;  // of the piece, ascending
  graph::ConflictGraph graph;
  std::vector<char> incomplete;  // has neighbours in other blocks
};

// `number` is -1 everywhere, and again in the end.
BlockGraph graph_of(const Piece& piece, std::vector<std::int32_t> vertices, std::vector<std::int32_t>& number) {
  BlockGraph block;
  block.vertices = std::move(vertices);
  for (std::size_t i = 0; i < block.vertices.size(); ++i) number[block.vertices[i]] = static_cast<std::int32_t>(i);
  for (const std::int32_t v : block.vertices) {
    block.incomplete.push_back(0);
    for (const std::int32_t u : piece.graph.neighbours_of(v))
      if (number[u] >= 0)
        block.graph.neighbours.push_back(number[u]);
      else
        block.incomplete.back() = 1;
    block.graph.offsets.push_back(static_cast<std::int64_t>(block.graph.neighbours.size()));
    block.graph.weights.push_back(piece.graph.weights[v]);
  }
  for (const std::int32_t v : block.vertices) number[v] = -1;
  return block;
}

void decide(Piece& piece, const BlockGraph& block, const Deadline& deadline) {
  mwis::reduce::ReductionLog log;
  mwis::reduce::Reducer reducer(block.graph, log, block.incomplete);
  reducer.run(mwis::reduce::ReductionEffort::quick, deadline);
  std::vector<std::uint8_t> taken(block.vertices.size(), 0);
  log.lift(taken);
  for (std::size_t i = 0; i < block.vertices.size(); ++i) {
    if (reducer.graph().alive(static_cast<std::int32_t>(i))) continue;
    piece.decided[block.vertices[i]] = 1;
    piece.chosen[block.vertices[i]] = taken[i];
  }
}

// Sends partners the decisions on shared vertices, by place in the list that both have.
void tell_partners(Ranks& ranks, Piece& piece) {
  struct Decision {
    std::uint32_t place, taken;
  };
  std::vector<int> to;
  std::vector<Bytes> news;
  for (const Piece::Partner& partner : piece.partners) {
    Packer packer;
    for (std::size_t i = 0; i < partner.shared.size(); ++i) {
      const std::int32_t v = partner.shared[i];
      if (piece.owns(v) && piece.decided[v] != 0) packer.put(Decision{static_cast<std::uint32_t>(i), piece.chosen[v]});
    }
    to.push_back(partner.rank);
    news.push_back(packer.take());
  }
  const std::vector<Bytes> heard = ranks.exchange(to, news);
  for (std::size_t i = 0; i < heard.size(); ++i)
    for (Unpacker unpacker(heard[i]); !unpacker.at_end();) {
      const auto decision = unpacker.get<Decision>();
      const std::int32_t v = piece.partners[i].shared[decision.place];
      piece.decided[v] = 1;
      piece.chosen[v] = static_cast<std::uint8_t>(decision.taken);
    }
}

}  // namespace

void reduce_blocks(Ranks& ranks, Piece& piece, const Deadline& deadline) {
  const std::int32_t first = piece.owners.first_of(piece.rank), last = piece.owners.first_of(piece.rank + 1);
  std::vector<std::vector<std::int32_t>> vertices(static_cast<std::size_t>(last - first));
  for (std::int32_t v = 0; v < piece.vertex_count(); ++v)
    if (piece.owns(v)) vertices[piece.block[v] - first].push_back(v);
  std::vector<std::int32_t> number(piece.keys.size(), -1);
  for (auto& block : vertices) decide(piece, graph_of(piece, std::move(block), number), deadline);
  tell_partners(ranks, piece);
}

}  // namespace hexpipe::lns_mpi
