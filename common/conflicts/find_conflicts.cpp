#include "common/conflicts/find_conflicts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "common/conflicts/conflicts.hpp"
#include "common/conflicts/packed_lists.hpp"
#include "common/conflicts/sorted_set.hpp"
#include "common/run/error.hpp"
#include "common/run/memory.hpp"
#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"

namespace hexpipe::conflicts {
namespace {

constexpr std::int64_t candidates_a_block = 256;

// The conflicts of each candidate with lower ones, packed, and the number of all its conflicts.
struct LowerConflicts {
  std::int64_t first = 0;           // the candidate of the first list
  std::vector<PackedLists> blocks;  // of candidates_a_block lists each
  std::vector<std::int64_t> degrees;
};

// Conflicts do not depend on these arrays, and they are a third of the memory of the candidates.
void forget_worth(Candidates& candidates) {
  candidates.quality = {};
  candidates.volume = {};
  candidates.boundary_tets = {};
  candidates.boundary_tet_offsets = {};
}

LowerConflicts find_lower_conflicts(const Candidates& candidates, const Share& share, const std::vector<bool>& own) {
  const std::size_t count = candidates.size();
  const std::optional<Candidates> dense = with_dense_ids(candidates);
  const ConflictFinder finder(dense ? *dense : candidates);
  struct Scratch {
    SortedSet found;
    std::vector<std::int32_t> degrees;
  };
  PerThread<Scratch> scratches(Scratch{SortedSet{count}, std::vector<std::int32_t>(count, 0)});
  LowerConflicts conflicts;
  conflicts.first = share.begin(static_cast<std::int64_t>(count));
  Step step("comparing hexes", 0.1, 0.75);
  step.expect(share.end(static_cast<std::int64_t>(count)) - conflicts.first);
  parallel_in_order(
      share.end(static_cast<std::int64_t>(count)) - conflicts.first, candidates_a_block,
      [&](std::int64_t begin, std::int64_t end) {
        Scratch& scratch = scratches.local();
        PackedLists lists;
        for (std::int64_t i = conflicts.first + begin; i < conflicts.first + end; ++i) {
          finder.collect_lower(static_cast<std::size_t>(i), scratch.found);
          const bool keeps_all = own.empty() || own[i];
          scratch.found.drain([&](std::int32_t j) {
            if (!keeps_all && !own[j]) return;
            lists.add(j);
            ++scratch.degrees[i];
            ++scratch.degrees[j];
          });
          lists.end_list();
        }
        lists.shrink_to_fit();
        return lists;
      },
      [&](PackedLists&& lists) {
        conflicts.blocks.push_back(std::move(lists));
        step.advance(candidates_a_block);
      });
  conflicts.degrees.assign(count, 0);
  scratches.for_each([&](const Scratch& scratch) {
    for (std::size_t i = 0; i < count; ++i) conflicts.degrees[i] += scratch.degrees[i];
  });
  return conflicts;
}

}  // namespace

// Conflicts are found once, from their higher end. They stay packed until all are counted, and the indices are freed
// before the graph takes its memory. Then both ends are written. Higher ends come in ascending order, so all lists
// ascend, too, and no list names a vertex above the higher ends so far. So the graph grows while the lists are freed.
graph::ConflictGraph conflict_graph(Candidates candidates, const ConflictOptions& options, const char* source,
                                    const std::vector<bool>& own) {
  const std::size_t count = candidates.size();
  if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw DataError::at(source, "expected fewer than 2^31 candidates, found {}", count);
  graph::ConflictGraph graph;
  Step all("building the graph of conflicts");
  graph.weights = weights_of(candidates, options.weight, options.weight_scale, source);

  forget_worth(candidates);
  LowerConflicts conflicts = find_lower_conflicts(candidates, options.share, own);
  candidates = {};
  graph.offsets.assign(count + 1, 0);
  std::partial_sum(conflicts.degrees.begin(), conflicts.degrees.end(), graph.offsets.begin() + 1);
  reserve_in_huge_pages(graph.neighbours, static_cast<std::size_t>(graph.offsets.back()));
  std::vector<std::int64_t>& next = conflicts.degrees;
  std::copy(graph.offsets.begin(), graph.offsets.end() - 1, next.begin());
  std::int64_t first = conflicts.first;
  FreedMemory freed;
  Step step(nullptr, 0.75, 1);
  step.expect(static_cast<std::int64_t>(conflicts.blocks.size()));
  for (PackedLists& lists : conflicts.blocks) {
    const std::int64_t end = std::min(first + candidates_a_block, static_cast<std::int64_t>(count));
    graph.neighbours.resize(graph.offsets[end]);
    lists.for_each(first, [&](std::int64_t i, std::int32_t j) {
      graph.neighbours[next[i]++] = j;
      graph.neighbours[next[j]++] = static_cast<std::int32_t>(i);
    });
    first = end;
    freed.add(lists.bytes());
    lists = {};
    step.advance();
  }
  graph.neighbours.resize(graph.offsets.back());
  return graph;
}

}  // namespace hexpipe::conflicts
