#pragma once
// The input's surface, which nothing may cross: the tagged triangles on its boundary, on its interfaces, and inside a
// region.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble::hybrid {

// Makes the mesh's triangles complete: afterwards they are facets of tets, and every facet of the boundary and of
// interfaces is among them.
void complete_surface(TetMesh& mesh, const TetAdjacency& adjacency);

// A tagged triangle in SurfaceTags.
using TaggedTriangle = Index<struct TaggedTriangleKind>;

// The tagged triangles and what covers a quad, less the flat tets that were peeled off the boundary (flat_tets.hpp)
// and the vertices that merged along it (gap/passes.hpp).
class SurfaceTags {
 public:
  // The surface of `mesh` is complete.
  explicit SurfaceTags(const TetMesh& mesh);

  // Whether each of these vertices is one of a tagged triangle. Most facets lie inside, and this tells so at once.
  bool is_on_surface(std::span<const Vertex> vertices) const {
    return std::ranges::all_of(
        vertices, [&](Vertex v) { return static_cast<std::size_t>(v) < is_on_any_.size() && is_on_any_[v]; });
  }
  bool contains(const Triangle& triangle) const { return find(triangle).has_value(); }
  // The tagged triangle with these vertices.
  std::optional<TaggedTriangle> find(const Triangle& triangle) const;
  std::size_t size() const { return triangles_.size(); }
  const Triangle& triangle(TaggedTriangle i) const { return triangles_[i]; }
  std::int32_t tag_of(TaggedTriangle i) const { return tags_[i]; }

  // Peels a tet off the boundary: the tagged triangles at `places`, two of its facets, become the other two.
  void peel(const Tet& tet, const std::array<TaggedTriangle, 2>& places, const std::array<Triangle, 2>& triangles);
  // Merges the vertex `from` into `into`; the tagged triangles with both are gone. `places`: those at `from`.
  // `between`: for each facet of the boundary that moves, the tet between its two places, which counts as taken off:
  // its volume is negative where the boundary moves outwards.
  void merge(Vertex from, Vertex into, std::span<const TaggedTriangle> places, std::span<const Tet> between);
  struct Merge {
    Vertex from, into;
  };
  // In the order in which they came.
  std::span<const Merge> merges() const { return merges_; }
  // The tets that were, and those between old and new boundary.
  std::span<const Tet> peeled() const { return peeled_; }

  // The two tagged triangles that a quad consists of, if the diagonal cuts it into two with one tag.
  struct Cover {
    std::array<TaggedTriangle, 2> triangles;
    bool operator==(const Cover&) const = default;
  };
  std::optional<Cover> cover_of(const Quad& quad, int diagonal) const;
  // As above, with either diagonal.
  std::optional<Cover> cover_of(const Quad& quad) const;
  // Whether the diagonal leaves the quad partly on tagged triangles: on one, or on two with different tags.
  bool covers_partly(const Quad& quad, int diagonal) const;

 private:
  IndexedVector<TaggedTriangle, Triangle> triangles_;
  IndexedVector<TaggedTriangle, std::int32_t> tags_;
  KeyMap<3, TaggedTriangle> numbers_;
  std::vector<bool> is_on_any_;  // by vertex
  std::vector<Tet> peeled_;
  std::vector<Merge> merges_;
};

// Which quads lie on the boundary of the input: they need no cell on their other side.
class BoundaryQuads {
 public:
  // `tags` are those of `mesh`, and outlive this.
  BoundaryQuads(const TetMesh& mesh, const TetAdjacency& adjacency, const SurfaceTags& tags);

  // Tagged triangles inside the mesh, with a tet on either side, do not count.
  bool contains(const Quad& quad) const;

 private:
  const SurfaceTags& tags_;
  std::vector<bool> is_outer_;  // by tagged triangle
};

}  // namespace hexpipe::assemble::hybrid
