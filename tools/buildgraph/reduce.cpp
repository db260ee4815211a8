#include "tools/buildgraph/reduce.hpp"

#include <algorithm>
#include <vector>

namespace hexpipe::buildgraph {

namespace {

template <class T>
void keep_items(std::vector<T>& items, std::span<const std::int32_t> kept) {
  for (std::size_t i = 0; i < kept.size(); ++i) items[i] = items[kept[i]];
  items.resize(kept.size());
}

void keep_lists(std::vector<std::int64_t>& offsets, std::vector<TetIndex>& items, std::span<const std::int32_t> kept) {
  std::int64_t end = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const std::int64_t from = offsets[kept[i]], to = offsets[kept[i] + 1];
    std::copy(items.begin() + from, items.begin() + to, items.begin() + end);
    offsets[i] = end;
    end += to - from;
  }
  offsets[kept.size()] = end;
  offsets.resize(kept.size() + 1);
  items.resize(end);
}

}  // namespace

void keep_only(Candidates& candidates, std::span<const std::int32_t> kept) {
  keep_items(candidates.vertices, kept);
  keep_items(candidates.kind, kept);
  keep_items(candidates.quality, kept);
  keep_items(candidates.volume, kept);
  keep_lists(candidates.tet_offsets, candidates.tets, kept);
  keep_lists(candidates.boundary_tet_offsets, candidates.boundary_tets, kept);
}

void keep_only(CandidateKeys& keys, std::span<const std::int32_t> kept) {
  keep_items(keys.key, kept);
  keep_items(keys.part, kept);
}

void keep_only(graph::ConflictGraph& graph, std::span<const std::int32_t> kept) {
  std::vector<std::int32_t> numbers(graph.weights.size(), no_index);
  for (std::size_t i = 0; i < kept.size(); ++i) numbers[kept[i]] = static_cast<std::int32_t>(i);
  std::int64_t end = 0, read = 0;
  for (std::size_t v = 0; v < numbers.size(); ++v) {
    const std::int64_t read_end = graph.offsets[v + 1];
    if (numbers[v] != no_index) {
      for (; read < read_end; ++read)
        if (const std::int32_t number = numbers[graph.neighbours[read]]; number != no_index)
          graph.neighbours[end++] = number;
      graph.weights[numbers[v]] = graph.weights[v];
      graph.offsets[numbers[v] + 1] = end;
    }
    read = read_end;
  }
  graph.neighbours.resize(end);
  graph.weights.resize(kept.size());
  graph.offsets.resize(kept.size() + 1);
}

std::int64_t reduce(Candidates& candidates, graph::ConflictGraph& graph) {
  const std::vector<std::int32_t> kept = undominated_vertices(graph);
  const auto dropped = static_cast<std::int64_t>(graph.weights.size() - kept.size());
  if (dropped == 0) return 0;
  keep_only(graph, kept);
  keep_only(candidates, kept);
  return dropped;
}

}  // namespace hexpipe::buildgraph
