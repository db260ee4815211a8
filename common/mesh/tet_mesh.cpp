#include "common/mesh/tet_mesh.hpp"

#include "common/mesh/check_cells.hpp"

namespace hexpipe {

void validate(const TetMesh& mesh, const char* source) {
  check_points(mesh.points, source);
  check_cells(mesh.tets, mesh.tet_tags, mesh.points.size(), "tets", source);
  check_cells(mesh.triangles, mesh.triangle_tags, mesh.points.size(), "triangles", source);
  if (mesh.ridges) check_corners(*mesh.ridges, mesh.points.size(), "ridges", source);
}

}  // namespace hexpipe
