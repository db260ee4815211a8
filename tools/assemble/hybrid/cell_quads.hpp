#pragma once
// Which cells are at each quad.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble {

using CellIndex = Index<struct CellOfHybridMesh>;

}  // namespace hexpipe::assemble

namespace hexpipe::assemble::hybrid {

// The quads of cells with consecutive numbers. At most two cells have the same quad.
class CellQuads {
 public:
  explicit CellQuads(std::size_t vertices) : first_(vertices, no_index) {}

  void reserve(std::size_t cells, std::size_t quads) { first_of_cell_.reserve(cells), sides_.reserve(quads); }
  void add_vertex() { first_.push_back(no_index); }

  // The cells that have the quad, the one that came first in front; no_index for those that there are not.
  std::array<CellIndex, 2> cells_at(const VertexKey<4>& quad) const;
  // The other cell at quad `i` of a cell, or no_index.
  CellIndex partner(CellIndex cell, int i) const { return sides_[side_of(cell, i)].partner; }

  // Adds the next cell, in the order of its quads.
  void add(CellIndex cell, std::span<const VertexKey<4>> quads);
  // Takes away the cell, which has `count` quads.
  void remove(CellIndex cell, int count);

 private:
  // A quad of a cell.
  using SideIndex = Index<struct SideOfCell>;
  struct Side {
    VertexKey<4> key;
    CellIndex cell, partner;
    SideIndex next;  // of those with the same least vertex
  };

  SideIndex side_of(CellIndex cell, int i) const { return SideIndex(first_of_cell_[cell] + i); }

  std::vector<SideIndex> first_;  // by vertex: the last side that came of those with this least vertex
  IndexedVector<SideIndex, Side> sides_;
  IndexedVector<CellIndex, std::int32_t> first_of_cell_;
};

}  // namespace hexpipe::assemble::hybrid
