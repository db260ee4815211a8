// The tets of a candidate, by a flood that does not cross the facets of the cell: J. Pellerin, A. Johnen, K. Verhetsel,
// J.-F. Remacle, Identifying combinations of tetrahedra into hexahedra: a vertex based strategy (IMR 2017),
// section 3.4. There the flood starts from any tet that joins four corners, which may lie outside; here from a tet
// behind a triangle that has to be on the cell's surface, and what was reached counts only if its outer facets are
// those of the cell.

#include "tools/findhex/cell_tets.hpp"

#include <algorithm>
#include <bit>

#include "common/mesh/quality.hpp"

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

// Rule 9: a scaled Jacobian that differs from that of three edges in one plane by no more than coordinates are rounded.
constexpr double flat = 1e-6;

template <class Topology>
constexpr auto facet_of_corners = make_facet_of_corners<Topology>();

}  // namespace

template <class Topology>
TetVerdict CellTets<Topology>::find(const CellCorners& corners) {
  corners_ = corners;
  star_.move_to(corners[0]);
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
  auto inside = [&](int a, int b, int c) { return star_.tet_inside(corners_[a], corners_[b], corners_[c]); };
  auto has = [&](int a, int b, int c) { return tables_.links().is_facet(corners_[a], corners_[b], corners_[c]); };
  Starts all;
  auto add = [&](std::int32_t tet) {
    if (tet != TetAdjacency::none) all.add(tet);
  };
  if constexpr (Topology::triangles.size() > 0) {
    const LocalTriangle& t = Topology::triangles[0];
    add(inside(t[0], t[1], t[2]));
    return all;
  }
  for (const LocalQuad& q : Topology::quads) {
    const bool diagonal_02 = has(q[0], q[1], q[2]) && has(q[0], q[2], q[3]);
    const bool diagonal_13 = has(q[0], q[1], q[3]) && has(q[1], q[2], q[3]);
    if (diagonal_02 == diagonal_13) continue;
    add(diagonal_02 ? inside(q[0], q[1], q[2]) : inside(q[0], q[1], q[3]));
    return all;
  }
  for (const LocalQuad& q : Topology::quads)
    for (const std::int32_t tet :
         {inside(q[0], q[1], q[2]), inside(q[0], q[2], q[3]), inside(q[0], q[1], q[3]), inside(q[1], q[2], q[3])}) {
      if (tet == TetAdjacency::none) continue;
      const auto b = corner_bits(tet);
      if ((b[0] | b[1] | b[2] | b[3]) != bits(q)) add(tet);
    }
  return all;
}

template <class Topology>
std::array<unsigned, 4> CellTets<Topology>::corner_bits(std::int32_t tet) const {
  std::array<unsigned, 4> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vertex v = tables_.flood_tet(tet).vertices[i];
    for (int c = 0; c < Topology::corner_count; ++c) result[i] |= v == corners_[c] ? bit(c) : 0u;
  }
  return result;
}

// The vertex of the tet beyond that the facet does not have: what is left of the eight of both tets when those of the
// facet, which come twice, and the one opposite cancel out.
template <class Topology>
Vertex CellTets<Topology>::apex_beyond(const TetFacet& facet, std::int32_t beyond) const {
  const Tet &a = tables_.flood_tet(facet.tet).vertices, &b = tables_.flood_tet(beyond).vertices;
  return a[0] ^ a[1] ^ a[2] ^ a[3] ^ a[facet.facet] ^ b[0] ^ b[1] ^ b[2] ^ b[3];
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
  interior_.sort();
  boundary_.sort();
  return TetVerdict::accepted;
}

// Rule 5.
template <class Topology>
TetVerdict CellTets<Topology>::flood_from(std::int32_t start) {
  interior_.clear();
  boundary_.clear();
  walls_.clear();
  has_inner_vertex_ = false;
  interior_.add(start);
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
  for (const unsigned bits_of : b) has_inner_vertex_ |= bits_of == 0;
  FixedVector<std::int32_t, 4> next;
  for (int facet = 0; facet < 4; ++facet) {
    const unsigned corners = all & ~b[facet];
    const int of_cell = facet_of_corners<Topology>[corners];
    walls_.push_back_if(of_cell >= 0, {tet, facet, of_cell, corners});
    next.push_back_if(of_cell < 0, tables_.flood_tet(tet).across[facet]);
  }
  for (const std::int32_t beyond : next) {
    if (beyond < 0) return TetVerdict::crosses_mesh;
    if (interior_.is_full() && !interior_.contains(beyond)) return TetVerdict::tet_count;
    interior_.add(beyond);
  }
  return TetVerdict::accepted;
}

// The flood may have come to both sides of a wall, where a triangle with three corners of a quad lies inside. The
// others are outside: one on each triangle of the cell, and two on each quad, at one of its diagonals.
template <class Topology>
TetVerdict CellTets<Topology>::find_outer_facets() {
  for (auto& facets : outer_) facets.clear();
  // With no more walls than outer facets all have to be outside: one inside would come twice, from either side.
  const bool may_be_inside = walls_.size() > 2 * quad_count + Topology::triangles.size();
  for (const WallFacet& wall : walls_) {
    if (may_be_inside && interior_.contains(tables_.usable_beyond(wall.tet, wall.facet))) {
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

// The two triangles that the interior tets have on a quad, the boundary tet on it if there is one, and rules 7 and 9
// for what is outermost.
template <class Topology>
TetVerdict CellTets<Topology>::judge_quad(std::size_t quad) {
  const LocalQuad& q = Topology::quads[quad];
  unsigned diagonal = outer_[quad][0].corners & outer_[quad][1].corners;
  std::array<TetFacet, 2> outermost{TetFacet{outer_[quad][0].tet, outer_[quad][0].facet},
                                    TetFacet{outer_[quad][1].tet, outer_[quad][1].facet}};
  const auto label = [&](const TetFacet& at) { return tables_.facet_label(at.tet, at.facet); };
  if (label(outermost[0]) != label(outermost[1])) return TetVerdict::half_on_surface;
  const std::int32_t beyond = tables_.usable_beyond(outermost[0].tet, outermost[0].facet);
  if (beyond == TetAdjacency::none) return TetVerdict::accepted;
  const unsigned missing = bits(q) & ~outer_[quad][0].corners;
  if (apex_beyond(outermost[0], beyond) == corners_[std::countr_zero(missing)]) {
    if (label(outermost[0]) != 0) return TetVerdict::crosses_mesh;
    boundary_.add(beyond);
    // Its two facets opposite the corners of the diagonal that the interior tets have are outside, at the other one.
    const auto b = corner_bits(beyond);
    std::size_t next = 0;
    for (int facet = 0; facet < 4; ++facet)
      if ((b[facet] & diagonal) != 0) outermost[next++] = {beyond, facet};
    diagonal = bits(q) & ~diagonal;
    if (label(outermost[0]) != label(outermost[1])) return TetVerdict::half_on_surface;
  }
  if (!rules_.flat_corners && label(outermost[0]) == 0 && has_flat_corner(q, diagonal, outermost))
    return TetVerdict::flat_corner;
  return TetVerdict::accepted;
}

// Rule 9 for a quad inside the mesh, of which the outermost triangles meet at this diagonal.
template <class Topology>
bool CellTets<Topology>::has_flat_corner(const LocalQuad& quad, unsigned diagonal,
                                         const std::array<TetFacet, 2>& outermost) const {
  std::array<std::int32_t, 2> beyond{};
  std::array<Vertex, 2> apex{};
  for (std::size_t i = 0; i < 2; ++i) {
    beyond[i] = tables_.usable_beyond(outermost[i].tet, outermost[i].facet);
    if (beyond[i] == TetAdjacency::none) return false;
    apex[i] = apex_beyond(outermost[i], beyond[i]);
  }
  if (apex[0] != apex[1]) return false;

  const auto& points = tables_.mesh().points;
  for (std::size_t i = 0; i < 4; ++i) {
    if ((bit(quad[i]) & diagonal) == 0) continue;
    // In both tets the facet opposite the other end of the diagonal is one at this corner and the apex.
    const Vertex other_end = corners_[quad[(i + 2) % 4]];
    const bool on_surface = std::ranges::all_of(beyond, [&](std::int32_t t) {
      const Tet& tet = tables_.mesh().tets[t];
      return tables_.facet_label(t, static_cast<int>(std::find(tet.begin(), tet.end(), other_end) - tet.begin())) != 0;
    });
    if (!on_surface) continue;
    const Vec3& at = points[corners_[quad[i]]];
    if (!scaled_jacobian_exceeds(points[corners_[quad[(i + 1) % 4]]] - at, points[corners_[quad[(i + 3) % 4]]] - at,
                                 points[apex[0]] - at, flat))
      return true;
  }
  return false;
}

template class CellTets<HexTopology>;
template class CellTets<PrismTopology>;
template class CellTets<PyramidTopology>;

}  // namespace hexpipe
