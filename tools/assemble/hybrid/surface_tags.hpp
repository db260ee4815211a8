#pragma once
// The tagged triangles of the input - its boundary, its interfaces, surfaces inside a region - which nothing may cross;
// less the flat tets that were taken off the boundary (peel.hpp), and the vertices that merged along it
// (merge_on_surface.hpp).

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble::hybrid {

class SurfaceTags {
 public:
  // `mesh` with every facet of its boundary and interfaces among its triangles.
  explicit SurfaceTags(const TetMesh& mesh);

  bool contains(const Triangle& triangle) const { return find(triangle).has_value(); }
  // The index of the tagged triangle with these vertices.
  std::optional<std::int32_t> find(const Triangle& triangle) const;
  std::size_t size() const { return triangles_.size(); }
  const Triangle& triangle(std::int32_t i) const { return triangles_[i]; }
  std::int32_t tag_of(std::int32_t i) const { return tags_[i]; }

  // Takes a tet off the boundary: two of its facets, tagged triangles, give way to the other two in their places.
  void peel(const Tet& tet, const std::array<std::int32_t, 2>& places, const std::array<Triangle, 2>& triangles);
  // Tagged triangles at `from` have `into` for it; those that have both vertices are gone. `places`: those at `from`.
  // `between`: for each facet of the boundary that moves, the tet between its two places, which counts as taken off:
  // its volume is negative where the boundary moves outwards.
  void merge(Vertex from, Vertex into, std::span<const std::int32_t> places, std::span<const Tet> between);
  struct Merge {
    Vertex from, into;
  };
  // In the order in which they came.
  std::span<const Merge> merges() const { return merges_; }
  // The tets that were, and those between old and new boundary.
  std::span<const Tet> peeled() const { return peeled_; }

  // The two tagged triangles that a quad consists of, when the diagonal cuts it into two with one tag.
  struct Cover {
    std::array<std::int32_t, 2> triangles;
    bool operator==(const Cover&) const = default;
  };
  std::optional<Cover> cover_of(const Quad& quad, int diagonal) const;
  // As above, with either diagonal.
  std::optional<Cover> cover_of(const Quad& quad) const;
  // True when the diagonal leaves the quad partly on tagged triangles: on one, or on two with different tags.
  bool covers_partly(const Quad& quad, int diagonal) const;

 private:
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> tags_;
  KeyMap<3, std::int32_t> numbers_;
  std::vector<bool> is_on_any_;  // by vertex: most triangles that are asked for lie inside, and are told so at once
  std::vector<Tet> peeled_;
  std::vector<Merge> merges_;
};

}  // namespace hexpipe::assemble::hybrid
