#include "tools/assemble/gap/face_costs.hpp"

#include <algorithm>
#include <optional>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// A face of one of the cells that are judged. Its vertices, ascending, are its key.
struct Side {
  std::uint64_t high, low;
  std::uint32_t cell;  // among those that are judged
  std::uint8_t face;   // of the cell, triangles before quads

  bool has_key_of(const Side& other) const { return high == other.high && low == other.low; }
  bool operator<(const Side& other) const {
    if (high != other.high) return high < other.high;
    if (low != other.low) return low < other.low;
    return cell < other.cell;
  }
};

FacesOf faces_of(const GapMesh& gap, CellKind kind, std::span<const Vertex> corners) {
  FacesOf faces{kind, {}, corner_points(gap.points(), corners)};
  std::ranges::copy(corners, faces.corners.begin());
  return faces;
}

// The corners of a face in their order around it, as corners of the cell.
std::span<const std::uint8_t> corners_of_face(CellKind kind, std::size_t face) {
  return with_topology(kind, [&](auto topology) -> std::span<const std::uint8_t> {
    using Topology = decltype(topology);
    constexpr std::size_t triangles = Topology::triangles.size();
    if constexpr (triangles > 0)
      if (face < triangles) return Topology::triangles[face];
    if constexpr (Topology::quads.size() > 0) return Topology::quads[face - triangles];
    return {};
  });
}

struct FaceCorners {
  std::array<Vec3, 4> at;
  std::size_t count = 0;

  FaceCorners(const FacesOf& cell, std::size_t face) {
    for (const std::uint8_t i : corners_of_face(cell.kind, face)) at[count++] = cell.points[i];
  }
};

FaceShape shape_of(const FacesOf& cell, std::size_t face) {
  const FaceCorners corners(cell, face);
  return face_shape(std::span<const Vec3>(corners.at).first(corners.count));
}

std::size_t face_count(CellKind kind) {
  return with_topology(
      kind, [](auto topology) { return decltype(topology)::triangles.size() + decltype(topology)::quads.size(); });
}

// In their order around the face; the fourth of a triangle is no_index.
std::array<Vertex, 4> vertices_of_face(CellKind kind, std::span<const Vertex> corners, std::size_t face) {
  std::array<Vertex, 4> own{no_index, no_index, no_index, no_index};
  std::size_t count = 0;
  for (const std::uint8_t i : corners_of_face(kind, face)) own[count++] = corners[i];
  return own;
}

Facet facet_of(CellKind kind, std::span<const Vertex> corners, std::size_t face) {
  const std::array<Vertex, 4> own = vertices_of_face(kind, corners, face);
  return Facet::of(std::span(own).first(corners_of_face(kind, face).size()));
}

Side side_of(CellKind kind, std::span<const Vertex> corners, std::size_t cell, std::size_t face) {
  const VertexKey<4> key = key_of(vertices_of_face(kind, corners, face));
  const auto pair = [&](std::size_t i) {
    return std::uint64_t{static_cast<std::uint32_t>(key[i])} << 32 | static_cast<std::uint32_t>(key[i + 1]);
  };
  return {pair(0), pair(2), static_cast<std::uint32_t>(cell), static_cast<std::uint8_t>(face)};
}

void append_sides(const FacesOf& cell, std::size_t number, std::vector<Side>& sides) {
  for (std::size_t face = 0; face < face_count(cell.kind); ++face)
    sides.push_back(side_of(cell.kind, cell.corners, number, face));
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
  const auto corners = facet.vertices();
  const Vertex at = *std::ranges::min_element(corners, {}, [&](Vertex v) { return gap.cells_at(v).size(); });
  for (const GapIndex c : gap.cells_at(at)) {
    const GapCell& cell = gap.cell(c);
    if (has_facet(cell.kind, cell.vertices(), facet) && std::ranges::find(without, c) == without.end())
      return gap.centre_of(c);
  }
  for (const KeptIndex c : gap.kept_at(at)) {
    const KeptCell& cell = gap.kept_cell(c);
    if (has_facet(cell.kind, cell.vertices(), facet)) return gap.centre_of_kept(c);
  }
  return std::nullopt;
}

// For each face whether there is a cell beyond it.
using InnerFaces = std::array<std::uint8_t, 6>;

double determinant_of(const FacesOf& cell, const InnerFaces& inner) {
  const auto count = static_cast<std::size_t>(corner_count(cell.kind));
  return cell_determinant(cell.kind, std::span<const Vec3>(cell.points).first(count), inner);
}

double cost_between(const GapMesh& gap, const FacesOf& cell, std::size_t face, const Vec3& behind, const Vec3& before) {
  const FaceShape shape = shape_of(cell, face);
  const double weight = face_weight(shape, behind, before);
  double cost = cost_of_face(orthogonality(shape, behind, before), weight);
  if (!gap.is_strict()) return cost;
  cost += cost_of_refused_weight(weight);
  const FaceCorners corners(cell, face);
  return corners.count == 4 ? cost + cost_of_refused_sight(diagonal_sight(corners.at, behind, before)) : cost;
}

double span_cost(const GapMesh& gap, const FacesOf& cell, const InnerFaces& inner) {
  const double determinant = determinant_of(cell, inner);
  if (!gap.is_strict()) return cost_of_span(determinant);
  return cost_of_span(determinant) + cost_of_refused_span(determinant);
}

// Whether the span of a cell's faces costs something: that of chosen hexes, whose faces are as they are, never does.
bool has_span_cost(const GapMesh& gap, CellKind kind, bool is_kept) {
  return !is_kept || (gap.is_strict() && kind != CellKind::hex);
}

// The centres of the cells that are judged. Those of chosen cells are computed only where one of their faces counts.
class Centres {
 public:
  explicit Centres(std::span<const FacesOf> cells) : cells_(cells), centres_(cells.size()) {}

  const Vec3& of(std::size_t c) {
    const FacesOf& cell = cells_[c];
    if (!centres_[c]) {
      const auto count = static_cast<std::size_t>(corner_count(cell.kind));
      centres_[c] = cell_centre(cell.kind, std::span(cell.points).first(count));
    }
    return *centres_[c];
  }

 private:
  std::span<const FacesOf> cells_;
  std::vector<std::optional<Vec3>> centres_;
};

}  // namespace

FaceGraph::FaceGraph(const GapMesh& gap, std::span<const FacesOf> cells, std::span<const GapIndex> instead_of)
    : gap_(&gap), inner_(cells.size()) {
  std::vector<Side> sides;
  sides.reserve(6 * cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) append_sides(cells[c], c, sides);
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& side = sides[i];
    const FacesOf& cell = cells[side.cell];
    if (i + 1 < sides.size() && sides[i + 1].has_key_of(side)) {
      const Side& other = sides[++i];
      inner_[side.cell][side.face] = inner_[other.cell][other.face] = 1;
      if (!cell.is_kept || !cells[other.cell].is_kept) faces_.push_back({side.cell, side.face, other.cell});
      continue;
    }
    if (!has_span_cost(gap, cell.kind, cell.is_kept)) continue;
    if (const auto beyond = centre_behind(gap, facet_of(cell.kind, cell.corners, side.face).reversed(), instead_of)) {
      if (!cell.is_kept) faces_.push_back({side.cell, side.face, none, *beyond});
      inner_[side.cell][side.face] = 1;
    }
  }
}

template <class Counts>
double FaceGraph::cost_of_faces_that(std::span<const FacesOf> cells, Counts&& counts) const {
  double cost = 0;
  Centres centres(cells);
  for (const Face& face : faces_)
    if (counts(face))
      cost += cost_between(*gap_, cells[face.cell], face.face, centres.of(face.cell),
                           face.other == none ? face.beyond : centres.of(face.other));
  return cost;
}

double FaceGraph::cost(std::span<const FacesOf> cells) const {
  double cost = cost_of_faces_that(cells, [](const Face&) { return true; });
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (has_span_cost(*gap_, cells[c].kind, cells[c].is_kept)) cost += span_cost(*gap_, cells[c], inner_[c]);
  return cost;
}

double FaceGraph::cost_at(std::span<const FacesOf> cells, std::span<const std::size_t> changing) const {
  const auto changes = [&](std::size_t c) { return c != none && std::ranges::binary_search(changing, c); };
  double cost = cost_of_faces_that(cells, [&](const Face& face) { return changes(face.cell) || changes(face.other); });
  for (const std::size_t c : changing)
    if (has_span_cost(*gap_, cells[c].kind, cells[c].is_kept)) cost += span_cost(*gap_, cells[c], inner_[c]);
  return cost;
}

double cost_of_faces(const GapMesh& gap, std::span<const FacesOf> cells, std::span<const GapIndex> instead_of) {
  return gap.counts_faces() ? FaceGraph(gap, cells, instead_of).cost(cells) : 0;
}

double cost_of_kept_span(const GapMesh& gap, KeptIndex c) {
  const KeptCell& cell = gap.kept_cell(c);
  if (!has_span_cost(gap, cell.kind, true)) return 0;
  FacesOf faces = faces_of(gap, cell.kind, cell.vertices());
  faces.is_kept = true;
  return cost_of_faces(gap, std::span(&faces, 1), {});
}

double cost_of_faces(const GapMesh& gap, std::span<const GapCell> cells, std::span<const GapIndex> instead_of) {
  if (!gap.counts_faces()) return 0;
  std::vector<FacesOf> faces;
  faces.reserve(cells.size());
  for (const GapCell& cell : cells) faces.push_back(faces_of(gap, cell.kind, cell.vertices()));
  return cost_of_faces(gap, faces, instead_of);
}

namespace {

// What each face of a cell that is there costs, found once as long as nothing around it changes.
const FaceCost& face_costs_of(const GapMesh& gap, GapIndex c) {
  FaceCost& known = gap.face_cost_of(c);
  const std::uint64_t age = gap.age_of_cell(c);
  if (known.age == age) return known;
  const FacesOf cell = faces_of(gap, gap.cell(c).kind, gap.cell(c).vertices());
  const Vec3 centre = gap.centre_of(c);
  FaceCost costs{.age = age};
  InnerFaces inner{};
  for (std::size_t face = 0; face < face_count(cell.kind); ++face)
    if (const auto beyond = centre_behind(gap, facet_of(cell.kind, cell.corners, face).reversed(), std::span(&c, 1))) {
      costs.of_faces[face] = cost_between(gap, cell, face, centre, *beyond);
      inner[face] = 1;
    }
  costs.of_span = span_cost(gap, cell, inner);
  for (const double cost : costs.of_faces) costs.cost += cost;
  costs.cost += costs.of_span;
  return known = costs;
}

// The faces of cells[i] that cost something, but not those that another cell before it in the list has, too.
void append_costly_sides(const GapMesh& gap, std::span<const GapIndex> cells, std::size_t i, std::vector<Side>& sides) {
  const FaceCost& costs = face_costs_of(gap, cells[i]);
  const GapCell& cell = gap.cell(cells[i]);
  for (std::size_t face = 0; face < face_count(cell.kind); ++face) {
    if (costs.of_faces[face] == 0) continue;
    const Facet beyond = facet_of(cell.kind, cell.vertices(), face).reversed();
    const bool is_counted = std::ranges::any_of(cells.first(i), [&](GapIndex other) {
      return has_facet(gap.cell(other).kind, gap.cell(other).vertices(), beyond);
    });
    if (!is_counted) sides.push_back(side_of(cell.kind, cell.vertices(), i, face));
  }
}

}  // namespace

double cost_of_faces(const GapMesh& gap, GapIndex c) {
  return gap.counts_faces() ? face_costs_of(gap, c).cost : 0;
}

bool is_refused(const GapMesh& gap, GapIndex c) {
  return gap.is_strict() && gap.is_alive(c) && cost_of_faces(gap, c) >= price_of_refusal;
}

double cost_of_faces(const GapMesh& gap, std::span<const GapIndex> cells) {
  if (!gap.counts_faces()) return 0;
  std::vector<Side> sides;
  for (std::size_t i = 0; i < cells.size(); ++i) append_costly_sides(gap, cells, i, sides);
  // In the order of FaceGraph: sums of one room are the same whichever way they come about.
  std::sort(sides.begin(), sides.end());
  double cost = 0;
  for (const Side& side : sides) cost += face_costs_of(gap, cells[side.cell]).of_faces[side.face];
  for (const GapIndex c : cells) cost += face_costs_of(gap, c).of_span;
  return cost;
}

}  // namespace hexpipe::assemble::gap
