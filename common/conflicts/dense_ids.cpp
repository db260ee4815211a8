#include "common/conflicts/conflicts.hpp"

#include <algorithm>
#include <vector>

#include "common/mesh/item_lists.hpp"

namespace hexpipe::conflicts {
namespace {

// A mesh has a few tets per candidate, or some more if candidates are few; a single candidate may name any number.
constexpr std::size_t ids_a_candidate = 64, ids_in_any_case = 1 << 20;

template <class Id>
void renumber(Id& id, const std::vector<Id>& distinct) {
  id = static_cast<Id>(std::lower_bound(distinct.begin(), distinct.end(), id) - distinct.begin());
}

}  // namespace

std::optional<Candidates> with_dense_ids(const Candidates& candidates) {
  std::int32_t highest = -1;
  for (const auto& row : candidates.vertices) highest = std::max(highest, *std::max_element(row.begin(), row.end()));
  for (const std::int32_t tet : candidates.tets) highest = std::max(highest, tet);
  if (highest < static_cast<std::int64_t>(ids_in_any_case + ids_a_candidate * candidates.size())) return std::nullopt;

  Candidates dense = candidates;
  std::vector<Vertex> vertices;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto corners = candidates.corners_of(i);
    vertices.insert(vertices.end(), corners.begin(), corners.end());
  }
  sort_unique(vertices);
  std::vector<TetIndex> tets = candidates.tets;
  sort_unique(tets);
  for (auto& row : dense.vertices)
    for (Vertex& v : row)
      if (v != no_index) renumber(v, vertices);
  for (TetIndex& tet : dense.tets) renumber(tet, tets);
  return dense;
}

}  // namespace hexpipe::conflicts
