#include "common/mesh/mixed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mesh/check_cells.hpp"

namespace hexpipe {
namespace {

template <int Corners>
void check_block(const CellBlock<Corners>& block, std::size_t point_count, const char* name, const char* source) {
  check_cells(block.cells, block.tags, point_count, name, source);
  if (!block.quality.empty() && block.quality.size() != block.size())
    throw DataError::at(source, "expected a quality for each of {} {} or none, found {}", block.size(), name,
                        block.quality.size());
  const auto wrong = std::ranges::find_if(block.quality, [](double quality) { return !std::isfinite(quality); });
  if (wrong != block.quality.end())
    throw DataError::at(source, "{}_quality[{}]: expected a finite number, found {}", name,
                        wrong - block.quality.begin(), *wrong);
}

}  // namespace

MixedMesh to_mixed_mesh(TetMesh mesh) {
  MixedMesh mixed;
  mixed.points = std::move(mesh.points);
  mixed.tets.cells = std::move(mesh.tets);
  mixed.tets.tags = std::move(mesh.tet_tags);
  mixed.triangles.cells = std::move(mesh.triangles);
  mixed.triangles.tags = std::move(mesh.triangle_tags);
  mixed.ridges = std::move(mesh.ridges);
  return mixed;
}

TetMesh to_tet_mesh(MixedMesh mesh, const char* source) {
  const std::pair<const char*, std::size_t> others[] = {{"hexes", mesh.hexes.size()},
                                                        {"prisms", mesh.prisms.size()},
                                                        {"pyramids", mesh.pyramids.size()},
                                                        {"quads", mesh.quads.size()}};
  for (const auto& [name, count] : others)
    if (count > 0) throw DataError::at(source, "expected tets and triangles only, found {} {}", count, name);
  return {std::move(mesh.points),          std::move(mesh.tets.cells),     std::move(mesh.tets.tags),
          std::move(mesh.triangles.cells), std::move(mesh.triangles.tags), std::move(mesh.ridges)};
}

void validate(const MixedMesh& mesh, const char* source) {
  const std::size_t points = mesh.points.size();
  check_points(mesh.points, source);
  check_block(mesh.hexes, points, "hexes", source);
  check_block(mesh.prisms, points, "prisms", source);
  check_block(mesh.pyramids, points, "pyramids", source);
  check_block(mesh.tets, points, "tets", source);
  check_block(mesh.triangles, points, "triangles", source);
  check_block(mesh.quads, points, "quads", source);
  if (mesh.ridges) check_corners(*mesh.ridges, points, "ridges", source);
}

}  // namespace hexpipe
