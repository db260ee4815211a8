// Quick reductions take a vertex or leave out a neighbour of it, for reasons within the neighbourhood of one vertex. If
// that neighbourhood is in one block, decisions of other blocks at the same time do not change the reason. So blocks
// need not hear of each other until all are done, and the result does not depend on the number of ranks.
#include "tools/lns-mpi/rounds.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/mwis/reduce/reducer.hpp"
#include "common/mwis/reduce/sample.hpp"

namespace hexpipe::lns_mpi {
namespace {

struct BlockGraph {
  std::vector<std::int32_t> vertices;  // of the local graph, ascending
  graph::ConflictGraph graph;
  std::vector<char> incomplete;  // has neighbours in other blocks
};

// `number` is no_index everywhere, before and after.
BlockGraph graph_of(const LocalGraph& local, std::vector<std::int32_t> vertices, std::vector<std::int32_t>& number) {
  BlockGraph block;
  block.vertices = std::move(vertices);
  for (std::size_t i = 0; i < block.vertices.size(); ++i) number[block.vertices[i]] = static_cast<std::int32_t>(i);
  for (const std::int32_t v : block.vertices) {
    block.incomplete.push_back(0);
    for (const std::int32_t u : local.graph.neighbours_of(v))
      if (number[u] != no_index)
        block.graph.neighbours.push_back(number[u]);
      else
        block.incomplete.back() = 1;
    block.graph.offsets.push_back(static_cast<std::int64_t>(block.graph.neighbours.size()));
    block.graph.weights.push_back(local.graph.weights[v]);
  }
  for (const std::int32_t v : block.vertices) number[v] = no_index;
  return block;
}

void decide(LocalGraph& local, const BlockGraph& block, const Deadline& deadline) {
  mwis::reduce::ReductionLog log;
  mwis::reduce::Reducer reducer(block.graph, log, block.incomplete);
  reducer.run(mwis::reduce::ReductionEffort::quick, deadline);
  std::vector<std::uint8_t> taken(block.vertices.size(), 0);
  log.lift(taken);
  for (std::size_t i = 0; i < block.vertices.size(); ++i) {
    if (reducer.graph().alive(static_cast<std::int32_t>(i))) continue;
    local.decided[block.vertices[i]] = 1;
    local.chosen[block.vertices[i]] = taken[i];
  }
}

// As lns decides it of a whole graph. All ranks decide the same, for any number of them.
bool are_worth_reducing(Ranks& ranks, const LocalGraph& local, const std::vector<std::vector<std::int32_t>>& vertices,
                        std::vector<std::int32_t>& number, const Deadline& deadline) {
  std::array<std::int64_t, 2> size{0, 0};
  for (const auto& block : vertices) {
    size[0] += std::ssize(block);
    for (const std::int32_t v : block) size[1] += local.graph.degree(v);
  }
  ranks.sum(size);
  if (!mwis::reduce::needs_sample(size[0], size[1])) return true;
  const std::int32_t blocks = local.owners.blocks();
  const std::int32_t places = (mwis::reduce::places_of_sample + blocks - 1) / blocks;
  std::array<std::int64_t, 2> sums{0, 0};
  for (const auto& block : vertices) {
    const BlockGraph graph = graph_of(local, block, number);
    const mwis::reduce::Sample sample = mwis::reduce::reduce_sample(graph.graph, places, graph.incomplete, deadline);
    sums[0] += sample.complete;
    sums[1] += sample.decided;
  }
  ranks.sum(sums);
  return mwis::reduce::Sample{sums[0], sums[1]}.decides_enough();
}

// Sends partners the decisions on shared vertices, by place in the list that both have.
void tell_partners(Ranks& ranks, LocalGraph& local) {
  struct Decision {
    std::uint32_t place, taken;
  };
  std::vector<int> to;
  std::vector<Bytes> news;
  for (const LocalGraph::Partner& partner : local.partners) {
    Packer packer;
    for (std::size_t i = 0; i < partner.shared.size(); ++i) {
      const std::int32_t v = partner.shared[i];
      if (local.owns(v) && local.decided[v] != 0) packer.put(Decision{static_cast<std::uint32_t>(i), local.chosen[v]});
    }
    to.push_back(partner.rank);
    news.push_back(packer.take());
  }
  const std::vector<Bytes> heard = ranks.all_to_all(to, news);
  for (std::size_t i = 0; i < heard.size(); ++i)
    for (Unpacker unpacker(heard[i]); !unpacker.at_end();) {
      const auto decision = unpacker.get<Decision>();
      const std::int32_t v = local.partners[i].shared[decision.place];
      local.decided[v] = 1;
      local.chosen[v] = static_cast<std::uint8_t>(decision.taken);
    }
}

}  // namespace

bool reduce_blocks(Ranks& ranks, LocalGraph& local, const Deadline& deadline) {
  const std::int32_t first = local.owners.first_of(local.rank), last = local.owners.first_of(local.rank + 1);
  std::vector<std::vector<std::int32_t>> vertices(static_cast<std::size_t>(last - first));
  for (std::int32_t v = 0; v < local.vertex_count(); ++v)
    if (local.owns(v)) vertices[local.block[v] - first].push_back(v);
  std::vector<std::int32_t> number(local.keys.size(), no_index);
  if (!are_worth_reducing(ranks, local, vertices, number, deadline)) return false;
  for (auto& block : vertices) decide(local, graph_of(local, std::move(block), number), deadline);
  tell_partners(ranks, local);
  return true;
}

}  // namespace hexpipe::lns_mpi
