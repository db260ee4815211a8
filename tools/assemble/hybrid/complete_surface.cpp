#include "tools/assemble/hybrid/complete_surface.hpp"

#include <cstddef>
#include <cstdint>

namespace hexpipe::assemble::hybrid {
namespace {

// Boundary facets that no triangle of the input names get this tag, as in findhex.
constexpr std::int32_t untagged = 0;

bool is_facet_of_a_tet(const Triangle& triangle, const TetMesh& mesh, const TetAdjacency& adjacency) {
  for (std::int32_t t : adjacency.tets_at(triangle[0])) {
    const Tet& tet = mesh.tets[t];
    auto has = [&](Vertex v) { return tet[0] == v || tet[1] == v || tet[2] == v || tet[3] == v; };
    if (has(triangle[1]) && has(triangle[2])) return true;
  }
  return false;
}

}  // namespace

void complete_surface(TetMesh& mesh, const TetAdjacency& adjacency) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!is_facet_of_a_tet(mesh.triangles[i], mesh, adjacency)) continue;
    mesh.triangles[kept] = mesh.triangles[i];
    mesh.triangle_tags[kept++] = mesh.triangle_tags[i];
  }
  mesh.triangles.resize(kept);
  mesh.triangle_tags.resize(kept);
  add_missing_boundary_triangles(mesh, adjacency, untagged);
}

}  // namespace hexpipe::assemble::hybrid
