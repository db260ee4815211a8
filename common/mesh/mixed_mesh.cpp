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

template <int Corners>
void check_nodes(const CellBlock<Corners>& block, const SecondOrder& nodes, std::uint8_t vtk, std::size_t point_count,
                 const char* name, const char* source) {
  const std::vector<Vertex>& list = nodes.of_kind(vtk);
  const std::size_t count = node_places_of(vtk).count(nodes.full);
  if (list.size() != count * block.size())
    throw DataError::at(source, "expected {} nodes behind the corners of each of {} {}, found {}", count, block.size(),
                        name, list.size());
  for (const auto& cell : block.cells)
    for (const Vertex v : cell)
      if (v >= nodes.first)
        throw DataError::at(source, "{}: expected corners below {}, where nodes of second order begin, found {}", name,
                            nodes.first, v);
  for (const Vertex v : list)
    if (v < nodes.first || static_cast<std::size_t>(v) >= point_count)
      throw DataError::at(source, "{}: expected nodes of second order from {} to below {}, found {}", name, nodes.first,
                          point_count, v);
}

void check_second_order(const MixedMesh& mesh, const char* source) {
  const SecondOrder& nodes = *mesh.second_order;
  const auto check = [&](CellKind kind, const auto& block, const char* name) {
    check_nodes(block, nodes, static_cast<std::uint8_t>(kind), mesh.points.size(), name, source);
  };
  check(CellKind::hex, mesh.hexes, "hexes");
  check(CellKind::prism, mesh.prisms, "prisms");
  check(CellKind::pyramid, mesh.pyramids, "pyramids");
  check(CellKind::tet, mesh.tets, "tets");
  check_nodes(mesh.triangles, nodes, vtk_code_of_triangle, mesh.points.size(), "triangles", source);
  check_nodes(mesh.quads, nodes, vtk_code_of_quad, mesh.points.size(), "quads", source);
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

void drop_second_order(MixedMesh& mesh) {
  if (!mesh.second_order) return;
  mesh.points.resize(std::min(mesh.points.size(), static_cast<std::size_t>(mesh.second_order->first)));
  mesh.second_order.reset();
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
  if (mesh.second_order) check_second_order(mesh, source);
}

}  // namespace hexpipe
