// The tets of a candidate, found by a flood that does not cross the facets of the cell: J. Pellerin, A. Johnen, K.
// Verhetsel, J.-F. Remacle, Identifying combinations of tetrahedra into hexahedra: a vertex based strategy (IMR 2017),
// section 3.4. Their flood starts from any tet that joins four corners, which may lie outside. This one starts from a
// tet behind a triangle that must be on the cell's surface, and the tets reached count only if their outer facets are
// those of the cell.

#include "common/candidates/cell_tets.hpp"

#include <algorithm>
#include <bit>

#include "common/mesh/quality.hpp"

namespace hexpipe::candidates {
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

// Maps three corners, as bits, to the number of the triangle that they form on a facet of the cell: 4 times the number
// of the quad plus the place of the corner left out; the cell's triangles follow. Corners that form no such triangle
// get the number of all triangles.
template <class Topology>
constexpr auto make_triangle_of_corners() {
  constexpr std::size_t count = 4 * Topology::quads.size() + Topology::triangles.size();
  static_assert(count < 32);
  std::array<std::uint8_t, 1u << Topology::corner_count> triangle_of{};
  triangle_of.fill(count);
  std::uint8_t next = 0;
  for (const LocalQuad& q : Topology::quads)
    for (const int left_out : q) triangle_of[bits(q) & ~bit(left_out)] = next++;
  for (const LocalTriangle& t : Topology::triangles) triangle_of[bits(t)] = next++;
  return triangle_of;
}
template <class Topology>
constexpr auto triangle_of_corners = make_triangle_of_corners<Topology>();

// Whether these triangles (bits) enclose the cell: on each quad two that leave out opposite corners, and every
// triangle.
template <class Topology>
constexpr bool encloses(std::uint32_t triangles) {
  constexpr std::size_t quad_bits = 4 * Topology::quads.size();
  constexpr std::uint32_t one_a_quad = 0x11111111u & ((1u << quad_bits) - 1);
  return ((triangles ^ triangles >> 2) & 3 * one_a_quad) == 0 &&
         ((triangles ^ triangles >> 1) & one_a_quad) == one_a_quad &&
         triangles >> quad_bits == (1u << Topology::triangles.size()) - 1;
}

// Rule 9: up to this scaled Jacobian, three edges cannot be told from edges in one plane, because coordinates are
// rounded.
constexpr double flat = 1e-6;

}  // namespace

template <class Topology>
TetVerdict CellTets<Topology>::find(const CellCorners& corners, Diagonals of_first_quad) {
  corners_ = corners;
  star_.move_to(corners[0]);
  for (int c = 0; c < Topology::corner_count; ++c) marks_.corner_bits[corners[c]] = static_cast<std::uint8_t>(bit(c));
  TetVerdict verdict = TetVerdict::no_interior;
  for (const TetIndex start : starts(of_first_quad)) {
    verdict = find_from(start);
    if (verdict == TetVerdict::accepted) break;
  }
  for (const Vertex v : corners) marks_.corner_bits[v] = 0;
  return verdict;
}

// The tets from which the flood may start: tets behind triangles of the cell's surface. One is enough if a facet is a
// triangle, or if the mesh has the triangles of only one diagonal of a quad. Otherwise some of these tets may be
// outside, and all have to be tried. A tet with all four corners of a quad starts no flood.
template <class Topology>
auto CellTets<Topology>::starts(Diagonals of_first_quad) const -> Starts {
  auto inside = [&](int a, int b, int c) { return star_.tet_inside(corners_[a], corners_[b], corners_[c]); };
  Starts all;
  auto add = [&](TetIndex tet) {
    if (tet != no_index && std::find(all.begin(), all.end(), tet) == all.end()) all.push_back(tet);
  };
  if constexpr (Topology::triangles.size() > 0) {
    const LocalTriangle& t = Topology::triangles[0];
    add(inside(t[0], t[1], t[2]));
    return all;
  }
  for (const LocalQuad& q : Topology::quads) {
    const Diagonals diagonals = &q == &Topology::quads[0] ? of_first_quad : diagonals_of(q);
    if (diagonals == (from_corner | between_sides)) continue;
    add(diagonals == from_corner ? inside(q[0], q[1], q[2]) : inside(q[0], q[1], q[3]));
    return all;
  }
  for (const LocalQuad& q : Topology::quads)
    for (const TetIndex tet :
         {inside(q[0], q[1], q[2]), inside(q[0], q[2], q[3]), inside(q[0], q[1], q[3]), inside(q[1], q[2], q[3])}) {
      if (tet == no_index) continue;
      const auto b = corner_bits(tables_.flood_tet(tet).vertices);
      if ((b[0] | b[1] | b[2] | b[3]) != bits(q)) add(tet);
    }
  return all;
}

template <class Topology>
Diagonals CellTets<Topology>::diagonals_of(const LocalQuad& q) const {
  const auto has = [&](int a, int b, int c) { return tables_.links().is_facet(corners_[a], corners_[b], corners_[c]); };
  const bool along = has(q[0], q[1], q[2]) && has(q[0], q[2], q[3]);
  const bool between = has(q[0], q[1], q[3]) && has(q[1], q[2], q[3]);
  return static_cast<Diagonals>((along ? from_corner : 0) | (between ? between_sides : 0));
}

template <class Topology>
std::array<unsigned, 4> CellTets<Topology>::corner_bits(const Tet& tet) const {
  const std::uint8_t* const bits_of = marks_.corner_bits.data();
  return {bits_of[tet[0]], bits_of[tet[1]], bits_of[tet[2]], bits_of[tet[3]]};
}

// The vertex of the tet beyond that is not on the facet. XOR over the eight vertices of both tets cancels those of the
// facet, which occur twice, and the one opposite.
template <class Topology>
Vertex CellTets<Topology>::apex_beyond(TetFacet facet, TetIndex beyond) const {
  const Tet &a = tables_.flood_tet(facet.tet).vertices, &b = tables_.flood_tet(beyond).vertices;
  return a[0] ^ a[1] ^ a[2] ^ a[3] ^ a[facet.facet] ^ b[0] ^ b[1] ^ b[2] ^ b[3];
}

template <class Topology>
TetVerdict CellTets<Topology>::find_from(TetIndex start) {
  interior_.clear();
  const TetVerdict verdict = judge_from(start);
  for (const TetIndex tet : interior_) marks_.interior[tet] = CellMarks::Interior::no;
  if (verdict == TetVerdict::accepted) {
    for (TetIndex& tet : interior_) tet = tables_.number_in_mesh(tet);
    for (TetIndex& tet : boundary_) tet = tables_.number_in_mesh(tet);
    interior_.sort();
    boundary_.sort();
  }
  return verdict;
}

template <class Topology>
TetVerdict CellTets<Topology>::judge_from(TetIndex start) {
  TetVerdict verdict = flood_from(start);
  if (verdict == TetVerdict::accepted) verdict = judge_walls();
  boundary_.clear();
  for (std::size_t quad = 0; quad < quad_count && verdict == TetVerdict::accepted; ++quad) verdict = judge_quad(quad);
  if (verdict != TetVerdict::accepted) return verdict;
  if (interior_.size() < least_interior_tets<Topology> || interior_.size() + boundary_.size() > most_tets<Topology>)
    return TetVerdict::tet_count;
  if (boundary_.size() > rules_.max_boundary_tets) return TetVerdict::boundary_tets;
  if (has_inner_vertex_ && !rules_.inner_vertices) return TetVerdict::inner_vertex;
  return TetVerdict::accepted;
}

// Rule 5.
template <class Topology>
TetVerdict CellTets<Topology>::flood_from(TetIndex start) {
  outer_ = inner_ = 0;
  has_inner_vertex_ = false;
  add_interior(start);
  TetVerdict verdict = TetVerdict::accepted;
  for (std::size_t next = 0; next < interior_.size() && verdict == TetVerdict::accepted; ++next)
    verdict = leave(interior_[next]);
  return verdict;
}

template <class Topology>
inline void CellTets<Topology>::add_interior(TetIndex tet) {
  interior_.push_back_if(marks_.interior[tet] == CellMarks::Interior::no, tet);
  marks_.interior[tet] = CellMarks::Interior::yes;
}

// Crosses the facets of an interior tet that are not on the cell's surface. For a facet that is not crossed, the tet
// itself stands in.
template <class Topology>
inline TetVerdict CellTets<Topology>::leave(TetIndex tet) {
  const MeshTables::FloodTet& at = tables_.flood_tet(tet);
  const auto b = corner_bits(at.vertices);
  const unsigned all = b[0] | b[1] | b[2] | b[3];
  std::array<Beyond, 4> next;
  std::int32_t any_next = 0;
  for (int facet = 0; facet < 4; ++facet) {
    has_inner_vertex_ |= b[facet] == 0;
    const std::size_t triangle = triangle_of_corners<Topology>[all & ~b[facet]];
    walls_[triangle] = {tet, facet};
    const std::uint32_t wall = 1u << triangle;
    inner_ |= outer_ & wall;
    outer_ ^= wall;
    next[facet] = triangle == triangle_count ? at.across[facet] : Beyond{tet};
    any_next |= next[facet].code;
  }
  if (any_next < 0) return stop_at(next);
  for (const Beyond beyond : next) add_interior(beyond.tet());
  return interior_.size() > most_tets<Topology> ? TetVerdict::tet_count : TetVerdict::accepted;
}

// Adds the tets before the first facet that cannot be crossed. Too many tets are the more important verdict.
template <class Topology>
TetVerdict CellTets<Topology>::stop_at(const std::array<Beyond, 4>& next) {
  for (std::size_t facet = 0; !next[facet].is_wall(); ++facet) add_interior(next[facet].tet());
  return interior_.size() > most_tets<Topology> ? TetVerdict::tet_count : TetVerdict::crosses_mesh;
}

// The flood may have come to both sides of a wall: there, a triangle with three corners of a quad lies inside. The
// other walls must be the outside: one on each triangle of the cell, and two, at one of the diagonals, on each quad.
template <class Topology>
TetVerdict CellTets<Topology>::judge_walls() const {
  constexpr std::uint32_t all = (1u << triangle_count) - 1;
  for (std::uint32_t inner = inner_ & all; inner != 0; inner &= inner - 1)
    if (tables_.facet_label(across(walls_[std::countr_zero(inner)])) != 0) return TetVerdict::crosses_mesh;
  return encloses<Topology>(outer_ & all) ? TetVerdict::accepted : TetVerdict::no_interior;
}

// Finds the two triangles that the interior tets have on a quad, and the boundary tet on it if there is one. Checks
// rules 7, 9 and 10 for the outermost triangles.
template <class Topology>
TetVerdict CellTets<Topology>::judge_quad(std::size_t quad) {
  const LocalQuad& q = Topology::quads[quad];
  const std::size_t left_out = (outer_ >> 4 * quad & 1) != 0 ? 0 : 1;
  std::array<TetFacet, 2> outermost{walls_[4 * quad + left_out], walls_[4 * quad + left_out + 2]};
  std::array<Beyond, 2> beyond{across(outermost[0]), across(outermost[1])};
  const auto labels_differ = [&] { return tables_.facet_label(beyond[0]) != tables_.facet_label(beyond[1]); };
  if (labels_differ()) return TetVerdict::half_on_surface;
  unsigned diagonal = bit(q[1 - left_out]) | bit(q[3 - left_out]);
  const auto is_at_sharp_edge = [&] {
    return !rules_.sharp_edges && tables_.facet_label(beyond[0]) != 0 && is_over_sharp_edge(q, diagonal);
  };
  const TetIndex sliver = tables_.usable_beyond(beyond[0]);
  if (sliver == no_index) return is_at_sharp_edge() ? TetVerdict::sharp_edge : TetVerdict::accepted;
  // A tet at both triangles has all four corners of the quad.
  if (sliver == tables_.usable_beyond(beyond[1])) {
    if (tables_.facet_label(beyond[0]) != 0) return TetVerdict::crosses_mesh;
    boundary_.push_back(sliver);
    // The interior tets have one diagonal. The sliver's two facets opposite the corners of that diagonal are outside,
    // at the other one.
    const auto b = corner_bits(tables_.flood_tet(sliver).vertices);
    std::size_t next = 0;
    for (int facet = 0; facet < 4; ++facet)
      if ((b[facet] & diagonal) != 0) outermost[next++] = {sliver, facet};
    diagonal = bits(q) & ~diagonal;
    beyond = {across(outermost[0]), across(outermost[1])};
    if (labels_differ()) return TetVerdict::half_on_surface;
  }
  if (is_at_sharp_edge()) return TetVerdict::sharp_edge;
  if (!rules_.flat_corners && tables_.facet_label(beyond[0]) == 0 && has_flat_corner(q, diagonal, outermost))
    return TetVerdict::flat_corner;
  return TetVerdict::accepted;
}

// Rule 10 for a quad on a surface whose triangles there meet at this diagonal.
template <class Topology>
bool CellTets<Topology>::is_over_sharp_edge(const LocalQuad& quad, unsigned diagonal) const {
  const std::size_t first = (bit(quad[0]) & diagonal) != 0 ? 0 : 1;
  const auto corner = [&](std::size_t i) { return corners_[quad[(first + i) % 4]]; };
  return tables_.is_sharp(corner(0), corner(1), corner(2), corner(3));
}

// Rule 9 for a quad inside the mesh whose outermost triangles meet at this diagonal.
template <class Topology>
bool CellTets<Topology>::has_flat_corner(const LocalQuad& quad, unsigned diagonal,
                                         const std::array<TetFacet, 2>& outermost) const {
  std::array<TetIndex, 2> beyond{};
  std::array<Vertex, 2> apex{};
  for (std::size_t i = 0; i < 2; ++i) {
    beyond[i] = tables_.usable_beyond(across(outermost[i]));
    if (beyond[i] == no_index) return false;
    apex[i] = apex_beyond(outermost[i], beyond[i]);
  }
  if (apex[0] != apex[1]) return false;

  const auto& points = tables_.mesh().points;
  for (std::size_t i = 0; i < 4; ++i) {
    if ((bit(quad[i]) & diagonal) == 0) continue;
    // In both tets, the facet opposite the other end of the diagonal contains this corner and the apex.
    const Vertex other_end = corners_[quad[(i + 2) % 4]];
    const bool on_surface = std::ranges::all_of(beyond, [&](TetIndex t) {
      const auto& [vertices, across] = tables_.flood_tet(t);
      return tables_.facet_label(across[std::find(vertices.begin(), vertices.end(), other_end) - vertices.begin()]) !=
             0;
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

}  // namespace hexpipe::candidates
