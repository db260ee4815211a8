#pragma once
// The facets of the tets that candidates may be made of, filed under their lowest vertex.

#include <cstdint>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

class FacetTable {
 public:
  static constexpr std::int32_t none = -1;

  struct Facet {
    Vertex middle, high;
    // The tets from which (low, middle, high) and (low, high, middle) are counter-clockwise seen from outside; none
    // where there is no usable tet.
    std::int32_t tets[2];
  };

  // Of the tets with usable[t] only.
  FacetTable(const TetMesh& mesh, const TetAdjacency& adjacency, const std::vector<bool>& usable);

  // The three vertices in any order.
  bool has(Vertex a, Vertex b, Vertex c) const { return find(a, b, c) != nullptr; }
  // The tet of which (a, b, c) is a facet, counter-clockwise seen from outside, or none.
  std::int32_t tet_inside(Vertex a, Vertex b, Vertex c) const;

 private:
  const Facet* find(Vertex a, Vertex b, Vertex c) const;

  std::vector<std::int64_t> offsets_;  // vertices + 1
  std::vector<Facet> facets_;          // by middle, then high
};

}  // namespace hexpipe
