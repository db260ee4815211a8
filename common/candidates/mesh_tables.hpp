#pragma once
// Tables of a mesh for the search, made once: which tets are usable, the facets, and the surface tags on them.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/candidates/vertex_links.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/defaults.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/orientation.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

// Changes to the mesh before it could be searched.
struct MeshFindings {
  TetOrientation orientation;  // inverted and flat tets are unusable
  std::int64_t derived_triangles = 0;
};

// A tet that a cell may reach across a facet, or a wall that no cell may reach across.
struct Beyond {
  std::int32_t code = 0;  // the tet, or ~ the number of the wall

  static Beyond wall(std::size_t number) { return {~static_cast<std::int32_t>(number)}; }
  bool is_wall() const { return code < 0; }
  TetIndex tet() const { return TetIndex(code); }
  std::int32_t wall_number() const { return ~code; }
};

class MeshTables {
 public:
  // `turns`: which tets have to be turned (TetOrientation::turns), if that is known. Throws DataError naming `source`
  // when a facet belongs to more than two tets.
  MeshTables(TetMesh mesh, const char* source, const std::vector<std::int8_t>& turns = {},
             double feature_angle = default_feature_angle);

  // The mesh with its tets in a new order. All tet numbers here, and in everything made from this, refer to that order.
  const TetMesh& mesh() const { return mesh_; }
  // The number that a tet had in the original mesh.
  TetIndex number_in_mesh(TetIndex tet) const { return tet_order_.empty() ? tet : tet_order_[tet]; }
  const TetAdjacency& adjacency() const { return adjacency_; }
  const VertexLinks& links() const { return *links_; }
  const MeshFindings& findings() const { return findings_; }
  bool usable(TetIndex tet) const { return usable_[tet]; }
  // The usable tet that has (a, b, c) as a facet, counter-clockwise seen from outside, or no_index.
  TetIndex tet_inside(Vertex a, Vertex b, Vertex c) const;

  // A tet with everything that a flood asks about it, in half a cache line.
  struct FloodTet {
    Tet vertices;
    // By facet. A cell may reach a tet that is usable and in the same region if no tag is between them.
    std::array<Beyond, 4> across;
  };
  const FloodTet& flood_tet(TetIndex tet) const { return flood_tets_[tet]; }
  // The usable tet beyond a facet, even if a wall is between, or no_index.
  TetIndex usable_beyond(Beyond across) const {
    return across.is_wall() ? walls_[across.wall_number()].usable_beyond : across.tet();
  }
  // 0 for a facet inside a region that has no surface tag. For other facets a number; two facets share it if they have
  // the same tag and are both on the boundary of the mesh or both inside it.
  std::int32_t facet_label(Beyond across) const { return across.is_wall() ? walls_[across.wall_number()].label : 0; }
  // Rule 10: the edge ac between the surface's triangles abc and acd is a ridge, or the surface turns there by more
  // than the feature angle.
  bool is_sharp(Vertex a, Vertex b, Vertex c, Vertex d) const;

 private:
  // A facet that no cell may reach across.
  struct Wall {
    TetIndex usable_beyond;
    std::int32_t label;
  };

  std::vector<bool> order_tets();
  void make_flood_tets();
  void label_walls();
  // Calls visit(tet, FoundFacet) for the one or two tets that have this facet.
  template <class Visit>
  void for_each_tet_at(const Triangle& facet, Visit&& visit) const;

  TetMesh mesh_;
  double feature_cosine_;
  KeySet<2> ridges_;
  MeshFindings findings_;
  std::vector<TetIndex> tet_order_;  // the original numbers; empty: the same
  std::vector<bool> usable_;
  TetAdjacency adjacency_;
  std::optional<VertexLinks> links_;
  std::vector<FloodTet> flood_tets_;
  std::vector<Wall> walls_;
};

}  // namespace hexpipe::candidates
