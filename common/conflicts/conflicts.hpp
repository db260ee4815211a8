#pragma once
// When two candidates cannot both be chosen, by the table of docs/definitions.md 2. And all conflicts of a candidate,
// from what it shares with others, without comparing it with everything near it.

#include <cstddef>
#include <optional>

#include "common/conflicts/segment_index.hpp"
#include "common/conflicts/sharing_index.hpp"
#include "common/conflicts/sorted_set.hpp"
#include "common/mesh/candidates.hpp"

namespace hexpipe::conflicts {

// Decides for one pair, from nothing but its tets and vertices.
bool in_conflict(const Candidates& candidates, std::size_t i, std::size_t j);

// Candidates may use vertex and tet numbers that are far larger than their count. If a table by these numbers would
// take far more memory than the candidates: the candidates with vertices and tets renumbered from 0 in the same order.
// Otherwise nothing.
std::optional<Candidates> with_dense_ids(const Candidates& candidates);

class ConflictFinder {
 public:
  explicit ConflictFinder(const Candidates& candidates);

  // Inserts the candidates below i that conflict with candidate i. The set must be empty and have room for all
  // candidates.
  void collect_lower(std::size_t i, SortedSet& found) const;

 private:
  template <class Topology>
  void collect_lower_of_kind(std::size_t i, SortedSet& found) const;

  const Candidates& candidates_;
  SegmentIndex segments_;
  SharingIndex quads_;
  SharingIndex tets_;
};

}  // namespace hexpipe::conflicts
