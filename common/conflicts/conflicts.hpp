#pragma once
// Finds all conflicts of a candidate from what it shares with others, without comparing it with everything near it.

#include <cstdint>

#include "common/conflicts/segment_index.hpp"
#include "common/conflicts/sharing_index.hpp"
#include "common/conflicts/sorted_set.hpp"
#include "common/mesh/candidates.hpp"

namespace hexpipe::conflicts {

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
