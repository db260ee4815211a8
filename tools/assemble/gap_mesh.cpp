#include "tools/assemble/gap_mesh.hpp"

#include <algorithm>
#include <stdexcept>

#include "tools/assemble/objective.hpp"

namespace hexpipe {

bool GapCell::has(Vertex v) const {
  return std::ranges::find(vertices(), v) != vertices().end();
}

GapMesh::GapMesh(const HybridMesh& mesh, const SurfaceTags& tags, std::span<const std::uint8_t> is_shared)
    : points_(mesh.points), at_(mesh.points.size()), fixed_(mesh.points.size()) {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.tet_count()); ++t)
    if (mesh.is_alive(t)) add(make_tet(mesh.tet(t), mesh.region_of(t)), t);
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.cell_count()); ++c) {
    const HybridCell& cell = mesh.cell(c);
    if (!cell.alive) continue;
    const std::span corners = std::span(cell.corners).first(corner_count(cell.kind));
    if (cell.kind == CellKind::pyramid && cell.candidate == HybridCell::none) {
      add(make_pyramid({corners[0], corners[1], corners[2], corners[3], corners[4]}, cell.region), c);
    } else {
      for (const Vertex v : corners) fixed_[v] = true;
    }
  }
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(tags.size()); ++i)
    for (const Vertex v : tags.triangle(i)) fixed_[v] = true;
  for (std::size_t v = 0; v < is_shared.size(); ++v)
    if (is_shared[v] != 0) fixed_[v] = true;
}

GapCell GapMesh::make_tet(const Tet& tet, std::int32_t region) const {
  return {CellKind::tet, {tet[0], tet[1], tet[2], tet[3], none}, region, tet_quality(points_, tet)};
}

GapCell GapMesh::make_pyramid(const std::array<Vertex, 5>& corners, std::int32_t region) const {
  return {CellKind::pyramid, corners, region, pyramid_quality(points_, corners)};
}

std::int32_t GapMesh::add(const GapCell& cell, std::int32_t source) {
  const auto c = static_cast<std::int32_t>(cells_.size());
  cells_.push_back(cell);
  alive_.push_back(1);
  source_.push_back(source);
  for (const Vertex v : cell.vertices()) at_[v].push_back(c);
  return c;
}

void GapMesh::replace(std::span<const std::int32_t> out, std::span<const GapCell> in) {
  for (const std::int32_t c : out) {
    alive_[c] = 0;
    for (const Vertex v : cells_[c].vertices()) std::erase(at_[v], c);
  }
  for (const GapCell& cell : in) add(cell, none);
}

void GapMesh::write_to(HybridMesh& mesh) const {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (alive_[c] != 0 || source_[c] == none) continue;
    if (cells_[c].kind == CellKind::tet)
      mesh.remove_tet(source_[c]);
    else
      mesh.remove_cell(source_[c]);
  }
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (alive_[c] == 0 || source_[c] != none) continue;
    const GapCell& cell = cells_[c];
    if (cell.kind == CellKind::tet) {
      mesh.add_tet({cell.corners[0], cell.corners[1], cell.corners[2], cell.corners[3]}, cell.region);
      continue;
    }
    HybridCell pyramid;
    pyramid.kind = CellKind::pyramid;
    std::ranges::copy(cell.corners, pyramid.corners.begin());
    std::fill(pyramid.corners.begin() + 5, pyramid.corners.end(), none);
    pyramid.region = cell.region;
    mesh.add_cell(pyramid);
  }
}

void GapMesh::check() const {
  std::size_t listed = 0, used = 0;
  for (std::size_t v = 0; v < at_.size(); ++v)
    for (const std::int32_t c : at_[v]) {
      ++listed;
      if (alive_[c] == 0 || !cells_[c].has(static_cast<Vertex>(v))) throw std::logic_error("a cell is at no corner");
    }
  for (std::size_t c = 0; c < cells_.size(); ++c)
    if (alive_[c] != 0) used += cells_[c].vertices().size();
  if (listed != used) throw std::logic_error("a cell is not at its corners");
}

}  // namespace hexpipe
