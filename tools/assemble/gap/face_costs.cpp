#include "tools/assemble/gap/face_costs.hpp"

#include <algorithm>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

Vec3 centre_of(std::span<const Vec3> points, CellKind kind, std::span<const Vertex> corners) {
  const auto at = corner_points(points, corners);
  return cell_centre(kind, std::span<const Vec3>(at).first(corners.size()));
}

bool has_facet(CellKind kind, std::span<const Vertex> corners, const Facet& facet) {
  for (const Vertex v : facet.vertices())
    if (std::ranges::find(corners, v) == corners.end()) return false;
  bool found = false;
  for_facets(kind, corners, [&](const Facet& own) { found = found || own == facet; });
  return found;
}

}  // namespace

FaceShape shape_of(const GapMesh& gap, const Facet& facet) {
  const auto at = corner_points(gap.points(), facet.vertices());
  return face_shape(std::span<const Vec3>(at).first(facet.vertices().size()));
}

Vec3 centre_of(const GapMesh& gap, const GapCell& cell) {
  return centre_of(gap.points(), cell.kind, cell.vertices());
}

std::optional<Vec3> centre_behind(const GapMesh& gap, const Facet& facet, std::span<const std::int32_t> without) {
  for (const std::int32_t c : gap.cells_at(facet.corners[0])) {
    const GapCell& cell = gap.cell(c);
    if (has_facet(cell.kind, cell.vertices(), facet) && std::ranges::find(without, c) == without.end())
      return centre_of(gap, cell);
  }
  for (const std::int32_t c : gap.kept_at(facet.corners[0])) {
    const KeptCell& cell = gap.kept_cell(c);
    if (has_facet(cell.kind, cell.vertices(), facet)) return centre_of(gap.points(), cell.kind, cell.vertices());
  }
  return std::nullopt;
}

double cost_of_faces(const GapMesh& gap, std::span<const GapCell> cells, std::span<const std::int32_t> instead_of) {
  if (!gap.counts_faces()) return 0;
  struct Open {
    Facet facet;
    Vec3 centre;
  };
  std::vector<Open> open;
  double cost = 0;
  auto add = [&](const Facet& facet, const Vec3& behind, const Vec3& before) {
    const FaceShape shape = shape_of(gap, facet);
    cost += cost_of_face(orthogonality(shape, behind, before), face_weight(shape, behind, before));
  };
  for (const GapCell& cell : cells) {
    const Vec3 centre = centre_of(gap, cell);
    for_facets(cell.kind, cell.vertices(), [&](const Facet& facet) {
      const Facet twin = facet.reversed();
      const auto found = std::ranges::find_if(open, [&](const Open& other) { return other.facet == twin; });
      if (found == open.end()) {
        open.push_back({facet, centre});
        return;
      }
      add(facet, centre, found->centre);
      open.erase(found);
    });
  }
  for (const Open& side : open)
    if (const auto beyond = centre_behind(gap, side.facet.reversed(), instead_of)) add(side.facet, side.centre, *beyond);
  return cost;
}

double cost_of_faces(const GapMesh& gap, std::span<const std::int32_t> cells) {
  if (!gap.counts_faces()) return 0;
  std::vector<GapCell> own;
  own.reserve(cells.size());
  for (const std::int32_t c : cells) own.push_back(gap.cell(c));
  return cost_of_faces(gap, own, cells);
}

}  // namespace hexpipe::assemble::gap
