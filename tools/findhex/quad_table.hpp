#pragma once
// The triangulated quads of a mesh (ALGORITHMS.md 1, rules 2 and 8), found once: four vertices in a cycle such that for
// one diagonal at least both triangles are facets and not folded over.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/findhex/facet_table.hpp"

namespace hexpipe {

// Rule 8 is broken by the quad abcd with diagonal ac: the normals of abc and acd do not agree.
inline bool is_folded(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 diagonal = c - a;
  return !(dot(cross(b - a, diagonal), cross(diagonal, d - a)) > 0);
}

// Which quads can be part of a candidate.
struct QuadFilter {
  double min_quality;  // the sine of no angle may be below: it bounds the scaled Jacobian there
  bool drop_folded;    // rule 8; where the mesh has both diagonals, one of them has to hold it
};

class QuadTable {
 public:
  QuadTable(const TetMesh& mesh, const TetAdjacency& adjacency, const FacetTable& facets, const QuadFilter& filter);

  // The vertices opposite `corner` in the quads where it lies between these two, ascending.
  std::span<const Vertex> opposites(Vertex corner, Vertex side, Vertex other_side) const;
  std::size_t size() const { return opposite_.size() / 4; }

 private:
  using Key = std::uint64_t;  // the lower side above the higher one
  static Key key(Vertex side, Vertex other_side);
  void file(const std::vector<std::array<Vertex, 4>>& quads, std::size_t vertex_count);

  // Every quad is filed at its four corners.
  std::vector<std::int64_t> offsets_;  // vertices + 1
  std::vector<Key> sides_;             // ascending at each corner
  std::vector<Vertex> opposite_;       // ascending for the same sides
};

}  // namespace hexpipe
