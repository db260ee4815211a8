#pragma once
// The tets behind facets at one vertex, for the many cells that begin there.

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/candidates/mesh_tables.hpp"
#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

class TetStar {
 public:
  explicit TetStar(const MeshTables& tables) : tables_(tables) {}

  // Files the usable tets at this vertex by the two other vertices of their facets there, in a hash table that is at
  // most half full. Vertices with too many tets get no table.
  void move_to(Vertex centre) {
    if (centre == centre_) return;
    centre_ = centre;
    slots_.fill({});
    const auto tets = tables_.adjacency().tets_at(centre);
    is_filed_ = 3 * tets.size() <= slots_.size() / 2;
    if (!is_filed_) return;
    for (const TetIndex t : tets)
      if (tables_.usable(t)) file(t);
  }

  // Answers as MeshTables::tet_inside does.
  TetIndex tet_inside(Vertex a, Vertex b, Vertex c) const {
    if (!is_filed_ || (a != centre_ && b != centre_ && c != centre_)) return tables_.tet_inside(a, b, c);
    if (b == centre_) return find(c, a);
    return c == centre_ ? find(a, b) : find(b, c);
  }

 private:
  static constexpr std::size_t slot_count = 512;
  struct Slot {
    Vertex next = no_index, after = no_index;  // the vertices after the centre, counter-clockwise seen from outside
    TetIndex tet = no_index;
  };

  static std::size_t first_slot(Vertex next, Vertex after) {
    const std::uint32_t hash = static_cast<std::uint32_t>(next) * 0x9e3779b9u + static_cast<std::uint32_t>(after);
    return hash * 0x85ebca6bu >> 23;
  }

  void file(TetIndex t) {
    const Tet& tet = tables_.mesh().tets[t];
    for (const LocalTriangle& facet : TetTopology::triangles) {
      const auto at =
          std::find_if(facet.begin(), facet.end(), [&](int c) { return tet[c] == centre_; }) - facet.begin();
      if (at == 3) continue;
      const Vertex next = tet[facet[(at + 1) % 3]], after = tet[facet[(at + 2) % 3]];
      std::size_t slot = first_slot(next, after);
      while (slots_[slot].next != no_index) slot = (slot + 1) % slot_count;
      slots_[slot] = {next, after, t};
    }
  }

  TetIndex find(Vertex next, Vertex after) const {
    for (std::size_t slot = first_slot(next, after);; slot = (slot + 1) % slot_count) {
      const Slot& at = slots_[slot];
      if (at.next == no_index || (at.next == next && at.after == after)) return at.tet;
    }
  }

  const MeshTables& tables_;
  Vertex centre_ = no_index;
  bool is_filed_ = false;
  std::array<Slot, slot_count> slots_{};
};

}  // namespace hexpipe::candidates
