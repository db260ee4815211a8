#pragma once
// The vertices and tets that two meshes of nearly the same points have in common: most tets stay when a few points
// move, come or go.

#include <cstdint>
#include <vector>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::search {

// A mesh, prepared for look-ups by the mesh that follows it.
class MeshIndex {
 public:
  explicit MeshIndex(const TetMesh& mesh);

 private:
  friend struct MeshChange;
  struct PlaceHash {
    std::size_t operator()(const Vec3& p) const;
  };
  std::size_t tet_count_;
  tsl::robin_map<Vec3, Vertex, PlaceHash> vertex_at_;
  KeyMap<4, std::int32_t> tet_of_;
};

struct MeshChange {
  MeshChange(const MeshIndex& before, const TetMesh& now);

  std::vector<Vertex> vertex_now;  // by vertex before, or no_index
  std::vector<TetIndex> tet_now;   // by tet before, or no_index
  std::vector<bool> is_touched;    // by vertex now: a tet at it has come or gone
};

}  // namespace hexpipe::tetmesh::search
