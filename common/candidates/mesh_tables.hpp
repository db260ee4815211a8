#pragma once
// What the search asks about a mesh, prepared once: which tets may be used, its facets, and the surface tags on them.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/candidates/vertex_links.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/feature_angle.hpp"
#include "common/mesh/orientation.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

// What the mesh needed before it could be searched.
struct MeshFindings {
  TetOrientation orientation;  // inverted and flat tets are unusable
  std::int64_t derived_triangles = 0;
};

class MeshTables {
 public:
  // `turns`: which tets are to be turned (TetOrientation::turns) where that is known. Throws DataError naming `source`
  // when a facet belongs to more than two tets.
  MeshTables(TetMesh mesh, const char* source, const std::vector<std::int8_t>& turns = {},
             double feature_angle = default_feature_angle);

  // Its tets stand in an order of their own, and all else here and in what is made of this counts them so.
  const TetMesh& mesh() const { return mesh_; }
  // What a tet's number was in the mesh as it came.
  std::int32_t number_in_mesh(std::int32_t tet) const { return tet_order_.empty() ? tet : tet_order_[tet]; }
  const TetAdjacency& adjacency() const { return adjacency_; }
  const VertexLinks& links() const { return *links_; }
  const MeshFindings& findings() const { return findings_; }
  bool usable(std::int32_t tet) const { return usable_[tet]; }
  // The usable tet of which (a, b, c) is a facet, counter-clockwise seen from outside, or none.
  std::int32_t tet_inside(Vertex a, Vertex b, Vertex c) const;

  // A tet with what is asked at each step of a flood, in half a cache line.
  struct FloodTet {
    Tet vertices;
    // The tet beyond each facet where a cell may reach across it: a usable one, in the same region, no tag between
    // them. Else negative.
    std::array<std::int32_t, 4> across;
  };
  const FloodTet& flood_tet(std::int32_t tet) const { return flood_tets_[tet]; }
  // The usable tet beyond a facet, whatever lies between, or none; of an entry of FloodTet::across.
  std::int32_t usable_beyond(std::int32_t across) const { return across >= 0 ? across : walls_[~across].usable_beyond; }
  // 0 where a facet lies inside a region and has no surface tag; else a number that two facets share when they have the
  // same tag and are both on the boundary of the mesh or both inside it.
  std::int32_t facet_label(std::int32_t across) const { return across >= 0 ? 0 : walls_[~across].label; }
  // Rule 10: the edge ac between the surface's triangles abc and acd is a ridge, or they turn by more than the feature
  // angle there.
  bool is_sharp(Vertex a, Vertex b, Vertex c, Vertex d) const;

 private:
  // A facet that no cell may reach across.
  struct Wall {
    std::int32_t usable_beyond, label;
  };

  std::vector<bool> order_tets();
  void make_flood_tets();
  void label_walls();
  // visit(tet, FoundFacet) of the tets, one or two, that have this facet.
  template <class Visit>
  void for_each_tet_at(const Triangle& facet, Visit&& visit) const;

  TetMesh mesh_;
  double feature_cosine_;
  KeySet<2> ridges_;
  MeshFindings findings_;
  std::vector<std::int32_t> tet_order_;  // numbers in the mesh as it came; empty: the same
  std::vector<bool> usable_;
  TetAdjacency adjacency_;
  std::optional<VertexLinks> links_;
  std::vector<FloodTet> flood_tets_;
  std::vector<Wall> walls_;
};

}  // namespace hexpipe::candidates
