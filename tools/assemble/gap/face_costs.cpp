#include "tools/assemble/gap/face_costs.hpp"

#include <algorithm>
#include <optional>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

struct Side {
  VertexKey<4> key;
  Facet facet;
  FaceShape shape;
  Vec3 centre;  // of the cell behind it
  bool is_kept;
  std::size_t cell;   // among those that are judged
  std::uint8_t face;  // of the cell, triangles before quads
};

FacesOf faces_of(const GapMesh& gap, CellKind kind, std::span<const Vertex> corners, bool is_kept) {
  FacesOf faces{kind, {}, corner_points(gap.points(), corners), is_kept};
  std::ranges::copy(corners, faces.corners.begin());
  return faces;
}

Vec3 centre_of(const GapMesh& gap, CellKind kind, std::span<const Vertex> corners) {
  const auto at = corner_points(gap.points(), corners);
  return cell_centre(kind, std::span<const Vec3>(at).first(corners.size()));
}

bool has_facet(CellKind kind, std::span<const Vertex> corners, const Facet& facet) {
  for (const Vertex v : facet.vertices())
    if (std::ranges::find(corners, v) == corners.end()) return false;
  bool found = false;
  for_facets(kind, corners, [&](const Facet& own) { found = found || own == facet; });
  return found;
}

// The centre of the cell of the mesh that has the facet as it goes around it, unless it is one of `without`; nothing on
// the boundary.
std::optional<Vec3> centre_behind(const GapMesh& gap, const Facet& facet, std::span<const GapIndex> without) {
  for (const GapIndex c : gap.cells_at(facet.corners[0])) {
    const GapCell& cell = gap.cell(c);
    if (has_facet(cell.kind, cell.vertices(), facet) && std::ranges::find(without, c) == without.end())
      return centre_of(gap, cell.kind, cell.vertices());
  }
  for (const KeptIndex c : gap.kept_at(facet.corners[0])) {
    const KeptCell& cell = gap.kept_cell(c);
    if (has_facet(cell.kind, cell.vertices(), facet)) return centre_of(gap, cell.kind, cell.vertices());
  }
  return std::nullopt;
}

void append_sides(const FacesOf& cell, std::size_t number, std::vector<Side>& sides) {
  const auto count = static_cast<std::size_t>(corner_count(cell.kind));
  const Vec3 centre = cell_centre(cell.kind, std::span<const Vec3>(cell.points).first(count));
  std::uint8_t face = 0;
  auto each = [&](const auto& facets) {
    for (const auto& facet : facets) {
      std::array<Vertex, 4> own{-1, -1, -1, -1};
      std::array<Vec3, 4> at{};
      for (std::size_t i = 0; i < facet.size(); ++i) own[i] = cell.corners[facet[i]], at[i] = cell.points[facet[i]];
      sides.push_back({key_of(own), Facet::of(std::span<const Vertex>(own).first(facet.size())),
                       face_shape(std::span<const Vec3>(at).first(facet.size())), centre, cell.is_kept, number,
                       face++});
    }
  };
  with_topology(cell.kind, [&](auto topology) {
    each(decltype(topology)::triangles);
    each(decltype(topology)::quads);
  });
}

// For each face whether there is a cell beyond it.
using InnerFaces = std::array<std::uint8_t, 6>;

double determinant_of(const FacesOf& cell, const InnerFaces& inner) {
  const auto count = static_cast<std::size_t>(corner_count(cell.kind));
  return cell_determinant(cell.kind, std::span<const Vec3>(cell.points).first(count), inner);
}

double cost_between(const FaceShape& shape, const Vec3& behind, const Vec3& before) {
  return cost_of_face(orthogonality(shape, behind, before), face_weight(shape, behind, before));
}

}  // namespace

double cost_of_faces(const GapMesh& gap, std::span<const FacesOf> cells, std::span<const GapIndex> instead_of) {
  if (!gap.counts_faces()) return 0;
  std::vector<Side> sides;
  for (std::size_t c = 0; c < cells.size(); ++c) append_sides(cells[c], c, sides);
  std::ranges::stable_sort(sides, {}, &Side::key);
  double cost = 0;
  std::vector<InnerFaces> inner(cells.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& side = sides[i];
    if (i + 1 < sides.size() && sides[i + 1].key == side.key) {
      ++i;
      inner[side.cell][side.face] = inner[sides[i].cell][sides[i].face] = 1;
      if (!side.is_kept || !sides[i].is_kept) cost += cost_between(side.shape, side.centre, sides[i].centre);
      continue;
    }
    if (side.is_kept) continue;
    if (const auto beyond = centre_behind(gap, side.facet.reversed(), instead_of)) {
      cost += cost_between(side.shape, side.centre, *beyond);
      inner[side.cell][side.face] = 1;
    }
  }
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (!cells[c].is_kept) cost += cost_of_span(determinant_of(cells[c], inner[c]));
  return cost;
}

double cost_of_faces(const GapMesh& gap, std::span<const GapCell> cells, std::span<const GapIndex> instead_of) {
  if (!gap.counts_faces()) return 0;
  std::vector<FacesOf> faces;
  for (const GapCell& cell : cells) faces.push_back(faces_of(gap, cell.kind, cell.vertices(), false));
  return cost_of_faces(gap, faces, instead_of);
}

double cost_of_faces(const GapMesh& gap, std::span<const GapIndex> cells) {
  if (!gap.counts_faces()) return 0;
  std::vector<FacesOf> faces;
  for (const GapIndex c : cells) faces.push_back(faces_of(gap, gap.cell(c).kind, gap.cell(c).vertices(), false));
  return cost_of_faces(gap, faces, cells);
}

}  // namespace hexpipe::assemble::gap
