#include "tools/tetmesh/search/mesh_change.hpp"

#include <array>
#include <bit>

#include "common/run/random.hpp"

namespace hexpipe::tetmesh::search {

std::size_t MeshIndex::PlaceHash::operator()(const Vec3& p) const {
  std::uint64_t key = 0;
  // makes -0 and 0 the same
  for (int axis = 0; axis < 3; ++axis) key = mix(key ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0));
  return static_cast<std::size_t>(key);
}

MeshIndex::MeshIndex(const TetMesh& mesh) : tet_count_(mesh.tets.size()) {
  vertex_at_.reserve(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) vertex_at_.emplace(mesh.points[v], static_cast<Vertex>(v));
  tet_of_.reserve(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    tet_of_.emplace(key_of(mesh.tets[t]), static_cast<std::int32_t>(t));
}

MeshChange::MeshChange(const MeshIndex& before, const TetMesh& now)
    : vertex_now(before.vertex_at_.size(), no_index),
      tet_now(before.tet_count_, no_index),
      is_touched(now.points.size()) {
  std::vector<Vertex> vertex_before(now.points.size(), no_index);
  for (std::size_t v = 0; v < now.points.size(); ++v) {
    const auto found = before.vertex_at_.find(now.points[v]);
    if (found == before.vertex_at_.end()) continue;
    vertex_before[v] = found->second;
    vertex_now[found->second] = static_cast<Vertex>(v);
  }
  for (std::size_t t = 0; t < now.tets.size(); ++t) {
    Tet corners = now.tets[t];
    for (Vertex& v : corners) v = vertex_before[v];
    // The key of a tet with a new vertex contains no_index, and is not found.
    const auto found = before.tet_of_.find(key_of(corners));
    if (found != before.tet_of_.end())
      tet_now[found->second] = TetIndex(t);
    else
      for (const Vertex v : now.tets[t]) is_touched[v] = true;
  }
  // A sliver on the boundary disappears without another in its place if the edge of the surface under it is flipped.
  for (const auto& [corners, t] : before.tet_of_) {
    if (tet_now[t] != no_index) continue;
    for (const Vertex v : corners)
      if (vertex_now[v] != no_index) is_touched[vertex_now[v]] = true;
  }
}

}  // namespace hexpipe::tetmesh::search
