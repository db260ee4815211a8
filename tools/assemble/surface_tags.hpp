#pragma once
// The tagged triangles of the input - its boundary, its interfaces, surfaces inside a region - which nothing may cross.

#include <cstdint>
#include <optional>

#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/facet_key.hpp"

namespace hexpipe {

class SurfaceTags {
 public:
  // `mesh` must outlive this, with every facet of its boundary and interfaces among its triangles.
  explicit SurfaceTags(const TetMesh& mesh);

  bool contains(const Triangle& triangle) const { return triangles_.contains(key_of(triangle)); }
  // The index of the tagged triangle with these vertices.
  std::optional<std::int32_t> find(const Triangle& triangle) const;
  std::int32_t tag_of(std::int32_t triangle) const { return mesh_.triangle_tags[triangle]; }

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
  const TetMesh& mesh_;
  KeyMap<3, std::int32_t> triangles_;
};

}  // namespace hexpipe
