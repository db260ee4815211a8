#include "tools/lns-mpi/regions.hpp"

#include <algorithm>
#include <numeric>

#include "common/run/random.hpp"

namespace hexpipe::lns_mpi {

Regions::Regions(const LocalGraph& local, const Searchers& searchers, std::uint64_t seed, std::int64_t round)
    : local_(local),
      first_own_(searchers.first_of(local.rank)),
      searchers_(searchers),
      priority_(static_cast<std::size_t>(local.owners.blocks())) {
  std::iota(priority_.begin(), priority_.end(), 0);
  // Every other round has the order of the one before, reversed: what was taken from a block comes back to it.
  Random(seed, static_cast<std::uint64_t>(round / 2)).shuffle(std::span(priority_));
  if (round % 2 != 0)
    for (std::uint64_t& priority : priority_) priority = priority_.size() - 1 - priority;

  const std::int32_t end_own = searchers.first_of(local.rank + 1);
  may_change_.resize(static_cast<std::size_t>(end_own - first_own_));
  block_ = local.block;
  for (std::int32_t v = 0; v < local.vertex_count(); ++v)
    for (const NearBlock& near : local.near_of(v))
      if (near.distance <= local.overlap && priority_[near.block] < priority_[block_[v]]) block_[v] = near.block;
  for (std::int32_t v = 0; v < local.vertex_count(); ++v) {
    const std::int32_t searcher = searchers.of_block(block_[v]);
    if (searcher >= first_own_ && searcher < end_own && local.decided[v] == 0 && !stays(v))
      may_change_[searcher - first_own_].push_back(v);
  }
  number_.assign(local.keys.size(), no_index);
}

// Whether a neighbour belongs to an earlier block of another searcher. A vertex with no other block nearby has none.
bool Regions::stays(std::int32_t v) const {
  if (local_.near_of(v).empty()) return false;
  const std::int32_t searcher = searchers_.of_block(block_[v]);
  return std::ranges::any_of(local_.graph.neighbours_of(v), [&](std::int32_t u) {
    return priority_[block_[u]] < priority_[block_[v]] && searchers_.of_block(block_[u]) != searcher;
  });
}

// Whether a chosen vertex outside of the region blocks v.
bool Regions::is_blocked(std::int32_t v) const {
  return std::ranges::any_of(local_.graph.neighbours_of(v),
                             [&](std::int32_t u) { return local_.chosen[u] != 0 && number_[u] == no_index; });
}

Region Regions::extract(std::int32_t searcher) {
  Region region;
  const auto& inside = may_change_[searcher - first_own_];
  for (const std::int32_t v : inside) number_[v] = 0;
  for (const std::int32_t v : inside)
    if (!is_blocked(v)) region.vertices.push_back(v);
  for (const std::int32_t v : inside) number_[v] = no_index;
  for (std::size_t i = 0; i < region.vertices.size(); ++i) number_[region.vertices[i]] = static_cast<std::int32_t>(i);
  for (std::size_t i = 0; i < region.vertices.size(); ++i) {
    const std::int32_t v = region.vertices[i];
    if (local_.chosen[v] != 0) region.chosen.push_back(static_cast<std::int32_t>(i));
    region.graph.weights.push_back(local_.graph.weights[v]);
    for (const std::int32_t u : local_.graph.neighbours_of(v))
      if (number_[u] != no_index) region.graph.neighbours.push_back(number_[u]);
    region.graph.offsets.push_back(static_cast<std::int64_t>(region.graph.neighbours.size()));
  }
  for (const std::int32_t v : region.vertices) number_[v] = no_index;
  return region;
}

}  // namespace hexpipe::lns_mpi
