#include "common/graph/clique_cover.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "common/mesh/candidates.hpp"

namespace hexpipe::graph {
namespace {

// Renumbers tets by their places among those that candidates have: any numbers are allowed, and memory depends on the
// places only.
std::vector<TetIndex> dense_tets(const Candidates& candidates) {
  std::vector<TetIndex> distinct = candidates.tets;
  std::ranges::sort(distinct);
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::vector<TetIndex> places = candidates.tets;
  for (TetIndex& tet : places) tet = TetIndex(std::ranges::lower_bound(distinct, tet) - distinct.begin());
  return places;
}

}  // namespace

CliqueCover cliques_of_tets(const Candidates& candidates) {
  CliqueCover cover;
  if (candidates.tets.empty()) return cover;
  const auto highest = static_cast<std::size_t>(std::ranges::max(candidates.tets));
  std::vector<TetIndex> places;
  if (highest >= 16 * candidates.tets.size()) places = dense_tets(candidates);
  const std::vector<TetIndex>& tets = places.empty() ? candidates.tets : places;

  std::vector<std::int64_t> offsets(static_cast<std::size_t>(std::ranges::max(tets)) + 2, 0);
  for (const TetIndex tet : tets) ++offsets[tet + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<CandidateIndex> members(tets.size());
  std::vector<std::int64_t> next(offsets.begin(), offsets.end() - 1);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::int64_t t = candidates.tet_offsets[i]; t < candidates.tet_offsets[i + 1]; ++t)
      members[next[tets[t]]++] = CandidateIndex(i);
  for (std::size_t tet = 0; tet + 1 < offsets.size(); ++tet)
    if (offsets[tet + 1] - offsets[tet] > 1)
      cover.add({members.begin() + offsets[tet], members.begin() + offsets[tet + 1]});
  return cover;
}

}  // namespace hexpipe::graph
