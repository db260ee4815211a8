#include "tools/buildgraph/buildgraph.hpp"

#include <limits>
#include <numeric>
#include <optional>

#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "tools/buildgraph/conflicts.hpp"
#include "tools/buildgraph/dense_ids.hpp"
#include "tools/buildgraph/sorted_set.hpp"

namespace hexpipe {
namespace {

constexpr std::int64_t candidates_a_block = 256;

}  // namespace

// Two passes, count and fill: the neighbours are stored once, in memory of just their size.
ConflictGraph buildgraph(const Candidates& candidates, const BuildgraphOptions& options, const char* source) {
  const std::size_t count = candidates.size();
  if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw DataError::at(source, "expected fewer than 2^31 candidates, found {}", count);
  ConflictGraph graph;
  graph.weights = weights_of(candidates, options.weight, options.weight_scale, source);

  const std::optional<Candidates> dense = with_dense_ids(candidates);
  const ConflictFinder finder(dense ? *dense : candidates);
  PerThread<SortedSet> sets(SortedSet{count});
  auto for_each_conflict = [&](std::int64_t i, auto&& visit) {
    SortedSet& found = sets.local();
    finder.collect(static_cast<std::size_t>(i), found);
    found.drain(visit);
  };
  graph.offsets.assign(count + 1, 0);
  parallel_for(static_cast<std::int64_t>(count), candidates_a_block, [&](std::int64_t i) {
    std::int64_t degree = 0;
    for_each_conflict(i, [&](std::int32_t) { ++degree; });
    graph.offsets[i + 1] = degree;
  });
  std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
  graph.neighbours.resize(graph.offsets.back());
  parallel_for(static_cast<std::int64_t>(count), candidates_a_block, [&](std::int64_t i) {
    auto next = graph.neighbours.begin() + graph.offsets[i];
    for_each_conflict(i, [&](std::int32_t j) { *next++ = j; });
  });
  return graph;
}

}  // namespace hexpipe
