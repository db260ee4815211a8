#include "tools/assemble/hybrid/cell_quads.hpp"

#include <cassert>

namespace hexpipe::assemble::hybrid {

std::array<CellIndex, 2> CellQuads::cells_at(const VertexKey<4>& quad) const {
  constexpr SameVertexKey<4> same;
  for (SideIndex s = first_[quad[0]]; s != no_index; s = sides_[s].next)
    if (const Side& side = sides_[s]; same(side.key, quad))
      return side.partner == no_index ? std::array{side.cell, CellIndex()} : std::array{side.partner, side.cell};
  return {};
}

void CellQuads::add(CellIndex cell, std::span<const VertexKey<4>> quads) {
  assert(static_cast<std::size_t>(cell) == first_of_cell_.size());
  constexpr SameVertexKey<4> same;
  first_of_cell_.push_back(static_cast<std::int32_t>(sides_.size()));
  for (const VertexKey<4>& quad : quads) {
    SideIndex other = first_[quad[0]];
    while (other != no_index && !same(sides_[other].key, quad)) other = sides_[other].next;
    const CellIndex partner = other == no_index ? CellIndex() : sides_[other].cell;
    if (other != no_index) {
      assert(sides_[other].partner == no_index);
      sides_[other].partner = cell;
    }
    const SideIndex side(sides_.size());
    sides_.push_back({quad, cell, partner, first_[quad[0]]});
    first_[quad[0]] = side;
  }
}

void CellQuads::remove(CellIndex cell, int count) {
  constexpr SameVertexKey<4> same;
  for (int i = 0; i < count; ++i) {
    const SideIndex gone = side_of(cell, i);
    SideIndex* at = &first_[sides_[gone].key[0]];
    while (*at != no_index) {
      if (*at == gone) {
        *at = sides_[gone].next;
        continue;
      }
      Side& side = sides_[*at];
      if (side.partner == cell && same(side.key, sides_[gone].key)) side.partner = no_index;
      at = &side.next;
    }
    sides_[gone].partner = no_index;
  }
}

}  // namespace hexpipe::assemble::hybrid
