#include "tools/tetmesh/tetgen/build_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/mesh/cell_topology.hpp"

namespace hexpipe::tetmesh::tetgen {
namespace {

// The cosines of the angles between facets. The facets opposite two corners meet at the edge that joins the other two.
std::array<double, 6> dihedral_cosines(const TetMesh& mesh, const Tet& tet) {
  std::array<Vec3, 4> normals;
  for (std::size_t facet = 0; facet < 4; ++facet) {
    const auto& corners = TetTopology::triangles[facet];
    const Vec3& origin = mesh.points[tet[corners[0]]];
    normals[facet] = cross(mesh.points[tet[corners[1]]] - origin, mesh.points[tet[corners[2]]] - origin);
  }
  std::array<double, 6> cosines{};
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [a, b] = TetTopology::edges[e];
    cosines[e] = -dot(normals[a], normals[b]) / (norm(normals[a]) * norm(normals[b]));
  }
  return cosines;
}

double degrees_of_cosine(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

}  // namespace

MeshShape shape_of(const TetMesh& mesh) {
  double greatest_cosine = -1, least_cosine = 1, volume = 0;
  for (const Tet& tet : mesh.tets) {
    volume += tet_determinant(mesh.points, tet) / 6;
    for (const double cosine : dihedral_cosines(mesh, tet)) {
      greatest_cosine = std::max(greatest_cosine, cosine);
      least_cosine = std::min(least_cosine, cosine);
    }
  }
  return {volume, degrees_of_cosine(greatest_cosine), degrees_of_cosine(least_cosine)};
}

}  // namespace hexpipe::tetmesh::tetgen
