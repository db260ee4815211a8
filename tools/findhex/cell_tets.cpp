// The tets of a candidate, by a flood that does not cross the facets of the cell: J. Pellerin, A. Johnen, K. Verhetsel,
// J.-F. Remacle, Identifying combinations of tetrahedra into hexahedra: a vertex based strategy (IMR 2017),
// section 3.4. There the flood starts from any tet that joins four corners, which may lie outside; here from a tet
// behind a triangle that has to be on the cell's surface, and what was reached counts only if its outer facets are
// those of the cell.

#include "tools/findhex/cell_tets.hpp"

#include <bit>

namespace hexpipe {
namespace {

constexpr unsigned bit(int corner) {
  return 1u << corner;
}

template <std::size_t Size>
constexpr unsigned bits(const std::array<std::uint8_t, Size>& corners) {
  unsigned set = 0;
  for (const int c : corners) set |= bit(c);
  return set;
}

// The facet of the cell (quads, then triangles) on which three of its corners lie, by their bits; -1 where there is
// none.
template <class Topology>
constexpr auto make_facet_of_corners() {
  std::array<std::int16_t, 1u << Topology::corner_count> facet_of{};
  facet_of.fill(-1);
  std::int16_t facet = 0;
  for (const LocalQuad& q : Topology::quads) {
    for (const int left_out : q) facet_of[bits(q) & ~bit(left_out)] = facet;
    ++facet;
  }
  for (const LocalTriangle& t : Topology::triangles) facet_of[bits(t)] = facet++;
  return facet_of;
}

template <class Topology>
constexpr auto facet_of_corners = make_facet_of_corners<Topology>();

}  // namespace

template <class Topology>
TetVerdict CellTets<Topology>::find(const CellCorners& corners) {
  corners_ = corners;
  TetVerdict verdict = TetVerdict::no_interior;
  for (const std::int32_t start : starts()) {
    verdict = find_from(start);
    if (verdict == TetVerdict::accepted) break;
  }
  return verdict;
}

// The tets behind triangles of the cell's surface. One is enough where a facet is a triangle or only one diagonal of a
// quad has its triangles in the mesh. Otherwise some of those found may be outside, and all have to be tried; the tet
// of a quad's four corners is on either side of none.
template <class Topology>
auto CellTets<Topology>::starts() const -> Starts {
  auto inside = [&](int a, int b, int c) { return tables_.tet_inside(corners_[a], corners_[b], corners_[c]); };
  auto has = [&](int a, int b, int c) { return tables_.links().is_facet(corners_[a], corners_[b], corners_[c]); };
  Starts all;
  auto add = [&](std::int32_t tet) {
    if (tet != TetAdjacency::none && !all.contains(tet)) all.push_back(tet);
  };
  if constexpr (Topology::triangles.size() > 0) {
    const LocalTriangle& t = Topology::triangles[0];
    add(inside(t[0], t[1], t[2]));
    return all;
  }
  for (const LocalQuad& q : Topology::quads) {
    const bool diagonal_02 = has(q[0], q[1], q[2]) && has(q[0], q[2], q[3]);
    const bool diagonal_13 = has(q[0], q[1], q[3]) && has(q[1], q[2], q[3]);
    if (diagonal_02 != diagonal_13) {
      all.clear();
      add(diagonal_02 ? inside(q[0], q[1], q[2]) : inside(q[0], q[1], q[3]));
      return all;
    }
    for (const std::int32_t tet :
         {inside(q[0], q[1], q[2]), inside(q[0], q[2], q[3]), inside(q[0], q[1], q[3]), inside(q[1], q[2], q[3])}) {
      if (tet == TetAdjacency::none) continue;
      const auto b = corner_bits(tet);
      if ((b[0] | b[1] | b[2] | b[3]) != bits(q)) add(tet);
    }
  }
  return all;
}

template <class Topology>
std::array<unsigned, 4> CellTets<Topology>::corner_bits(std::int32_t tet) const {
  std::array<unsigned, 4> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vertex v = tables_.mesh().tets[tet][i];
    for (int c = 0; c < Topology::corner_count; ++c) result[i] |= v == corners_[c] ? bit(c) : 0u;
  }
  return result;
}

template <class Topology>
TetVerdict CellTets<Topology>::find_from(std::int32_t start) {
  TetVerdict verdict = flood_from(start);
  if (verdict == TetVerdict::accepted) verdict = find_outer_facets();
  for (std::size_t quad = 0; quad < quad_count && verdict == TetVerdict::accepted; ++quad) verdict = judge_quad(quad);
  if (verdict != TetVerdict::accepted) return verdict;
  if (interior_.size() < least_interior_tets<Topology> || interior_.size() + boundary_.size() > most_tets<Topology>)
    return TetVerdict::tet_count;
  if (boundary_.size() > rules_.max_boundary_tets) return TetVerdict::boundary_tets;
  if (has_inner_vertex_ && !rules_.inner_vertices) return TetVerdict::inner_vertex;
  std::sort(interior_.begin(), interior_.end());
  std::sort(boundary_.begin(), boundary_.end());
  return TetVerdict::accepted;
}

// Rule 5.
template <class Topology>
TetVerdict CellTets<Topology>::flood_from(std::int32_t start) {
  interior_.clear();
  boundary_.clear();
  walls_.clear();
  has_inner_vertex_ = false;
  interior_.push_back(start);
  TetVerdict verdict = TetVerdict::accepted;
  for (std::size_t next = 0; next < interior_.size() && verdict == TetVerdict::accepted; ++next)
    verdict = leave(interior_[next]);
  return verdict;
}

// Crosses the facets of an interior tet that are not on the cell's surface.
template <class Topology>
TetVerdict CellTets<Topology>::leave(std::int32_t tet) {
  const auto b = corner_bits(tet);
  const unsigned all = b[0] | b[1] | b[2] | b[3];
  if (std::popcount(all) < 4) has_inner_vertex_ = true;
  const auto beyond = tables_.adjacency().tets_beyond(tet);
  for (int facet = 0; facet < 4; ++facet) {
    const unsigned corners = all & ~b[facet];
    const int of_cell = facet_of_corners<Topology>[corners];
    if (of_cell >= 0) {
      walls_.push_back({tet, facet, of_cell, corners});
      continue;
    }
    const std::int32_t next = beyond[facet];
    // Facets on the boundary and between regions always have a label.
    if (tables_.facet_label(tet, facet) != 0 || !tables_.usable(next)) return TetVerdict::crosses_mesh;
    if (interior_.contains(next)) continue;
    if (interior_.is_full()) return TetVerdict::tet_count;
    interior_.push_back(next);
  }
  return TetVerdict::accepted;
}

// The flood may have come to both sides of a wall, where a triangle with three corners of a quad lies inside. The
// others are outside: one on each triangle of the cell, and two on each quad, at one of its diagonals.
template <class Topology>
TetVerdict CellTets<Topology>::find_outer_facets() {
  for (auto& facets : outer_) facets.clear();
  for (const WallFacet& wall : walls_) {
    if (interior_.contains(tables_.adjacency().tet_beyond(wall.tet, wall.facet))) {
      if (tables_.facet_label(wall.tet, wall.facet) != 0) return TetVerdict::crosses_mesh;
      continue;
    }
    if (outer_[wall.of_cell].is_full()) return TetVerdict::no_interior;
    outer_[wall.of_cell].push_back(wall);
  }
  for (std::size_t quad = 0; quad < quad_count; ++quad) {
    const LocalQuad& q = Topology::quads[quad];
    if (outer_[quad].size() != 2) return TetVerdict::no_interior;
    const unsigned shared = outer_[quad][0].corners & outer_[quad][1].corners;
    if (shared != (bit(q[0]) | bit(q[2])) && shared != (bit(q[1]) | bit(q[3]))) return TetVerdict::no_interior;
  }
  for (std::size_t triangle = quad_count; triangle < facet_count; ++triangle)
    if (outer_[triangle].size() != 1) return TetVerdict::no_interior;
  return TetVerdict::accepted;
}

// The two triangles that the interior tets have on a quad, the boundary tet on it if there is one, and rule 7 for what
// is outermost.
template <class Topology>
TetVerdict CellTets<Topology>::judge_quad(std::size_t quad) {
  const LocalQuad& q = Topology::quads[quad];
  const auto& facets = outer_[quad];
  const std::int32_t label = tables_.facet_label(facets[0].tet, facets[0].facet);
  if (label != tables_.facet_label(facets[1].tet, facets[1].facet)) return TetVerdict::half_on_surface;
  const std::int32_t beyond = tables_.adjacency().tet_beyond(facets[0].tet, facets[0].facet);
  if (beyond == TetAdjacency::none || !tables_.usable(beyond)) return TetVerdict::accepted;
  const auto b = corner_bits(beyond);
  if ((b[0] | b[1] | b[2] | b[3]) != bits(q)) return TetVerdict::accepted;

  if (label != 0) return TetVerdict::crosses_mesh;
  boundary_.push_back(beyond);
  const unsigned shared = facets[0].corners & facets[1].corners;
  // Its two facets at the corners of the diagonal that the interior tets have lie against those; the others are
  // outside.
  std::int32_t outermost = -1;
  for (int facet = 0; facet < 4; ++facet) {
    if ((b[facet] & shared) == 0) continue;
    const std::int32_t found = tables_.facet_label(beyond, facet);
    if (outermost >= 0 && found != outermost) return TetVerdict::half_on_surface;
    outermost = found;
  }
  return TetVerdict::accepted;
}

template class CellTets<HexTopology>;
template class CellTets<PrismTopology>;
template class CellTets<PyramidTopology>;

}  // namespace hexpipe
