#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

CellSet with_neighbours(const MeasuredMesh& mesh, const CellSet& cells) {
  CellSet all = cells;
  for (const std::int32_t cell : cells)
    for (const std::int32_t face : mesh.faces_of(cell))
      if (mesh.mesh().faces[face].is_inner()) all.push_back(mesh.mesh().faces[face].other_cell(cell));
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

RefusalCount count_refusals(const MeasuredMesh& mesh, const CellSet& cells) {
  RefusalCount result;
  const auto add = [&](Refusals refusals) {
    result.wrong += (refusals & wrong) != 0 ? 1 : 0;
    result.severe += (refusals & severe) != 0 ? 1 : 0;
  };
  for (const std::int32_t cell : cells) {
    if (!mesh.is_alive(cell)) continue;
    add(mesh.refusals_of_cell(cell));
    for (const std::int32_t face : mesh.faces_of(cell)) {
      const std::int32_t other = mesh.mesh().faces[face].other_cell(cell);
      if (other == no_index || other > cell || !contains(cells, other)) add(mesh.refusals_of_face(face));
    }
  }
  return result;
}

}  // namespace hexpipe::polyhedra
