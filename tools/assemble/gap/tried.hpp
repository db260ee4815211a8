#pragma once
// Remembers places where nothing was found, so that they are tried again only after a change there.

#include <tsl/robin_set.h>

#include <cstdint>
#include <span>

#include "tools/assemble/gap/gap_mesh.hpp"

namespace hexpipe::assemble::gap {

class TriedRooms {
 public:
  // A number for these cells, in any order, as they are now: ages rise with each change at a vertex. Vertices count,
  // too, because GapMesh::undo_replace() gives numbers of cells free. Two rooms with one number cost one filling at
  // most.
  static std::uint64_t state_of(const GapMesh& gap, std::span<const GapIndex> cells) {
    std::uint64_t state = 0;
    for (const GapIndex c : cells) {
      std::uint64_t own = static_cast<std::uint32_t>(c);
      for (const Vertex v : gap.cell(c).vertices())
        own += (std::uint64_t{gap.age_of(v)} << 32 | static_cast<std::uint32_t>(v)) * 0xbf58476d1ce4e5b9u;
      own = (own ^ own >> 31) * 0x9e3779b97f4a7c15u;
      state += own ^ own >> 29;
    }
    return state;
  }

  bool contains(std::uint64_t state) const { return states_.contains(state); }
  void insert(std::uint64_t state) { states_.insert(state); }

 private:
  tsl::robin_set<std::uint64_t> states_;
};

}  // namespace hexpipe::assemble::gap
