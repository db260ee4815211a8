#include "tools/assemble/gap_mesh.hpp"

#include <algorithm>
#include <stdexcept>

#include "tools/assemble/objective.hpp"

namespace hexpipe {

bool GapCell::has(Vertex v) const {
  return std::ranges::find(vertices(), v) != vertices().end();
}

GapMesh::GapMesh(HybridMesh& mesh, const SurfaceTags& tags, std::span<const std::uint8_t> is_shared)
    : points_(mesh.points), tags_(tags), at_(mesh.points.size()), fixed_(mesh.points.size()) {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.tet_count()); ++t)
    if (mesh.is_alive(t)) {
      const auto& [a, b, c, d] = mesh.tet(t);
      add(make(CellKind::tet, {a, b, c, d}, mesh.region_of(t)), t);
    }
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.cell_count()); ++c) {
    const HybridCell& cell = mesh.cell(c);
    if (!cell.alive) continue;
    const std::span corners = std::span(cell.corners).first(corner_count(cell.kind));
    if (cell.candidate == HybridCell::none) {
      std::array<Vertex, 6> six{};
      std::ranges::copy(corners, six.begin());
      add(make(cell.kind, six, cell.region), c);
    } else {
      for (const Vertex v : corners) fixed_[v] = true;
    }
  }
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(tags.size()); ++i)
    for (const Vertex v : tags.triangle(i)) fixed_[v] = true;
  for (std::size_t v = 0; v < is_shared.size(); ++v)
    if (is_shared[v] != 0) fixed_[v] = true;
}

GapCell GapMesh::make(CellKind kind, const std::array<Vertex, 6>& corners, std::int32_t region) const {
  GapCell cell{kind, corners, region};
  cell.quality = gap_quality(kind, points_, cell.vertices());
  return cell;
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
    HybridCell made;
    made.kind = cell.kind;
    made.corners.fill(none);
    std::ranges::copy(cell.vertices(), made.corners.begin());
    made.region = cell.region;
    mesh.add_cell(made);
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
