#pragma once
// All conflicts of a candidate, from what it shares with others, without comparing it with everything near by.

#include <cstdint>

#include "common/mesh/candidates.hpp"
#include "tools/buildgraph/sharing_index.hpp"
#include "tools/buildgraph/sorted_set.hpp"

namespace hexpipe {

class ConflictFinder {
 public:
  explicit ConflictFinder(const Candidates& candidates);

  // Inserts the candidates that conflict with candidate i into an empty set with room for all.
  void collect(std::size_t i, SortedSet& found) const;

 private:
  template <class Topology>
  void collect_of_kind(std::size_t i, SortedSet& found) const;

  const Candidates& candidates_;
  SharingIndex pairs_;  // by two corners
  SharingIndex quads_;
  SharingIndex tets_;
};

}  // namespace hexpipe
