#pragma once
// Every facet of the cells of a mixed mesh and the one or two cells that have it, found from the result alone.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::assemble::hybrid {

// A facet in canonical form. Triangle: its vertices in ascending order, then no_index. Quad: its least vertex, the one
// opposite, then the other two in ascending order, so that a quad in another cyclic order is another facet.
struct FacetForm {
  std::array<Vertex, 4> vertices;
  bool forward;  // one of the two ways around

  static FacetForm of(std::span<const Vertex> corners);
  bool is_quad() const { return vertices[3] >= 0; }
};

class CellFacets {
 public:
  struct Entry {
    std::array<Vertex, 4> vertices;  // as in FacetForm
    std::int32_t uses = 0;           // cells that have it
    bool one_way = false;            // two of its cells go around it the same way: they overlap
    bool forward = false;            // how the first cell goes around it
    std::array<std::int32_t, 2> regions{};
    bool tagged = false;  // for the caller
    bool is_quad() const { return vertices[3] >= 0; }
  };

  explicit CellFacets(const MixedMesh& mesh);

  std::span<Entry> entries() { return entries_; }
  // nullptr if no cell has the facet.
  Entry* find(const FacetForm& facet);

 private:
  std::vector<std::int64_t> offsets_;  // by least vertex
  std::vector<Entry> entries_;         // by least vertex, then by the others
};

// Calls visit(kind, corners, tag) for every cell.
template <class Visit>
void for_each_cell(const MixedMesh& mesh, Visit&& visit) {
  auto each = [&](CellKind kind, const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) visit(kind, std::span<const Vertex>(block.cells[i]), block.tags[i]);
  };
  each(CellKind::hex, mesh.hexes);
  each(CellKind::prism, mesh.prisms);
  each(CellKind::pyramid, mesh.pyramids);
  each(CellKind::tet, mesh.tets);
}

}  // namespace hexpipe::assemble::hybrid
