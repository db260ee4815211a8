#pragma once
// The search for all cells of one kind: rules 1 to 3 and 8 of docs/definitions.md 1. It follows the plan of
// search_plan.hpp.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/candidates/mesh_tables.hpp"
#include "common/candidates/quads.hpp"
#include "common/candidates/search_plan.hpp"
#include "common/mesh/quality.hpp"

namespace hexpipe::candidates {

// Calls body(std::integral_constant) for 0 .. count - 1, at compile time.
template <std::size_t count, class Body>
constexpr void for_each_index(Body&& body) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (body(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<count>{});
}

// The same until a body returns false; returns whether none did.
template <std::size_t count, class Body>
constexpr bool all_of_indices(Body&& body) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return (body(std::integral_constant<std::size_t, i>{}) && ...);
  }
  (std::make_index_sequence<count>{});
}

// Visit is called as visit(corners, points, diagonals): arrays of a cell's vertices and their points in the numbering
// of Topology, and the diagonals of its first quad, seen from corner 0.
template <class Topology, class Visit>
class CellSearch {
 public:
  static constexpr std::size_t corner_count = Topology::corner_count;
  using CellCorners = std::array<Vertex, corner_count>;
  using CellPoints = std::array<Vec3, corner_count>;

  CellSearch(const MeshTables& tables, const QuadFilter& filter, Visit visit)
      : tables_(tables), filter_(filter), visit_(std::move(visit)) {}

  // Visits the cells whose corner 0 is this vertex; `fan` has the quads of this vertex. In these cells all quads and
  // triangles exist, and the scaled Jacobian of every corner exceeds the least quality. Each cell is visited under one
  // of its labellings.
  void visit_cells_at(Vertex corner_0, const QuadFan& fan) {
    fan_ = &fan;
    corners_[first] = corner_0;
    set<0>();
    place<1>();
  }

 private:
  template <std::size_t step>
  static constexpr const SearchStep& plan = search_plan<Topology>[step];
  static constexpr std::uint8_t first = first_corner<Topology>;
  static constexpr bool is_at_first(const PlanQuad& quad) { return quad.corner == first; }

  template <std::size_t step>
  void place() {
    if constexpr (step == corner_count) {
      static_assert(Topology::quads[0][0] == first);
      visit_(corners_, points_, diagonals_[0]);
    } else {
      for_each_choice<step>([&](Vertex v, int from_quad) {
        corners_[plan<step>.corner] = v;
        if ((!closes_at_first<step>() && !may_stand<step>(v)) || !facets_close<step>(from_quad) ||
            !outer_corners_suffice<step>() || !quads_open<step>())
          return;
        set<step>();
        if (corners_suffice<step>()) place<step + 1>();
      });
    }
  }

  template <std::size_t step>
  void set() {
    constexpr std::uint8_t corner = plan<step>.corner;
    points_[corner] = tables_.mesh().points[corners_[corner]];
    for_each_index<plan<step>.edges.size()>([&](auto i) {
      constexpr std::uint8_t edge = plan<step>.edges[i];
      edges_[edge] = points_[Topology::edges[edge][1]] - points_[Topology::edges[edge][0]];
      squares_[edge] = norm_squared(edges_[edge]);
    });
  }

  // Calls body(vertex, quad) for each vertex that may become the new corner. `quad` is the quad that the vertex came
  // from and that it closes, or no_index. Every edge of a cell is a side of one of its facets, so rule 1 follows from
  // rule 2 and from the facets.
  template <std::size_t step, class Body>
  void for_each_choice(Body&& body) {
    constexpr std::uint8_t corner = plan<step>.corner;
    if constexpr (plan<step>.closed_quads.size() > 0) {
      constexpr PlanQuad quad = plan<step>.closed_quads[0];
      if constexpr (closes_at_first<step>()) {
        for (auto quads = fan_->quads_of(*pairs_[quad.quad]); !quads.empty();) {
          const auto some = quads.first(std::min<std::size_t>(quads.size(), 64));
          quads = quads.subspan(some.size());
          for (std::uint64_t bits = choosable<step, quad>(some); bits != 0; bits &= bits - 1) {
            const QuadFan::Quad& found = some[std::countr_zero(bits)];
            set_outer_edges<quad, corner>(found);
            body(found.opposite, quad.quad);
          }
        }
      } else {
        const int fewest = quad_with_fewest<step>();
        for (const OppositeCorner& opposite : angles_[fewest].find_opposites(tables_.links(), found_))
          body(opposite.vertex, fewest);
      }
    } else if constexpr (opens_at_first<step>()) {
      const auto neighbours = tables_.links().neighbours_of(corners_[first]);
      for (std::size_t word = 0; word < fan_->word_count(); ++word)
        for (std::uint64_t bits = choosable_neighbours<step>(word); bits != 0; bits &= bits - 1) {
          places_[corner] = fan_->first_place() + static_cast<int>(64 * word) + std::countr_zero(bits);
          body(neighbours[places_[corner]], no_index);
        }
    } else {
      static_assert(plan<step>.is_beside_first);
      const auto neighbours = tables_.links().neighbours_of(corners_[first]);
      for (std::size_t place = exceeds<step>(first) ? fan_->first_place() : 0; place < neighbours.size(); ++place) {
        places_[corner] = static_cast<int>(place);
        body(neighbours[place], no_index);
      }
    }
  }

  // Takes up to 64 quads at the first corner. Returns, as bits, those whose fourth vertex may stand opposite. Their
  // outer edges must fit the placed ones (rule 3) and, where a pair is still open, some edge of it. These answers are
  // hard to predict, so everything is computed for all quads, without branches.
  template <std::size_t step, PlanQuad quad>
  std::uint64_t choosable(std::span<const QuadFan::Quad> quads) const {
    const auto side_of = [&](std::uint8_t corner) -> std::size_t {
      return places_[corner] > places_[corner == quad.side ? quad.other_side : quad.side] ? 1 : 0;
    };
    std::array<std::uint64_t, 2> allowed{~std::uint64_t{0}, ~std::uint64_t{0}};
    for_each_index<plan<step>.outer_corners.size()>([&](auto i) {
      constexpr OuterCorner c = plan<step>.outer_corners[i];
      if constexpr (c.end == plan<step>.corner)
        allowed[side_of(c.corner)] &= fan_->suffices_after(outer_edges_[c.corner][c.next_end]);
      else
        allowed[side_of(c.corner)] &= fan_->suffices_before(outer_edges_[c.corner][c.end]);
    });
    std::uint64_t bits = 0;
    for (std::size_t q = 0; q < quads.size(); ++q) {
      const QuadFan::Quad& found = quads[q];
      bool may = may_stand<step>(found.opposite);
      for_each_index<plan<step>.open_corners.size()>([&](auto i) {
        constexpr OpenCorner open = plan<step>.open_corners[i];
        may &= open_corner_may_suffice<open>(found.outer_edges[side_of(open.corner.corner)]);
      });
      const std::uint64_t go_with_all = allowed[0] >> found.numbers[0] & allowed[1] >> found.numbers[1];
      bits |= (go_with_all & (may ? 1 : 0)) << q;
    }
    return bits;
  }

  // Among the quads that the new corner closes, away from the first corner: the one that leaves the fewest choices.
  template <std::size_t step>
  int quad_with_fewest() const {
    int fewest = plan<step>.closed_quads[0].quad;
    for_each_index<plan<step>.closed_quads.size()>([&](auto i) {
      constexpr PlanQuad quad = plan<step>.closed_quads[i];
      if (!is_at_first(quad) && angles_[quad.quad].opposite_count() < angles_[fewest].opposite_count())
        fewest = quad.quad;
    });
    return fewest;
  }

  // Returns, as bits (64 to a word), the neighbours of the first vertex that have a quad in common with it and with
  // each side that is placed. If the new corner completes the first one, they also fit its two other edges (rule 3).
  template <std::size_t step>
  std::uint64_t choosable_neighbours(std::size_t word) const {
    constexpr std::uint8_t corner = plan<step>.corner;
    std::uint64_t bits = ~std::uint64_t{0};
    for_each_index<plan<step>.opened_quads.size()>([&](auto i) {
      constexpr PlanQuad quad = plan<step>.opened_quads[i];
      constexpr std::uint8_t other = quad.side == corner ? quad.other_side : quad.side;
      if constexpr (is_at_first(quad)) bits &= fan_->partners_of(places_[other], word);
      if constexpr (is_at_first(quad) && exceeds<step>(other)) bits &= fan_->greater_than(places_[other], word);
    });
    for_each_index<plan<step>.corners.size()>([&](auto i) {
      constexpr LocalCorner c = plan<step>.corners[i];
      if constexpr (c[0] == first) {
        static_assert(c[3] == corner);
        bits &= fan_->third_edges(places_[c[1]], places_[c[2]], word);
      }
    });
    return bits;
  }

  template <std::size_t step>
  static constexpr bool exceeds(std::uint8_t corner) {
    for (std::size_t i = 0; i < plan<step>.greater.size(); ++i)
      if (plan<step>.greater[i] == corner) return true;
    return false;
  }

  // The new corner is sought as the opposite of the first one in a quad.
  template <std::size_t step>
  static constexpr bool closes_at_first() {
    return plan<step>.closed_quads.size() > 0 && is_at_first(plan<step>.closed_quads[0]);
  }

  // The new corner is beside the first one in a quad.
  template <std::size_t step>
  static constexpr bool opens_at_first() {
    return plan<step>.opened_quads.size() > 0 && is_at_first(plan<step>.opened_quads[0]);
  }

  // One labelling per cell, and no vertex twice. Everything is compared, because a branch for each would cost more.
  template <std::size_t step>
  bool may_stand(Vertex v) const {
    bool may = true;
    for_each_index<plan<step>.greater.size()>([&](auto i) { may &= v > corners_[plan<step>.greater[i]]; });
    for_each_index<step>([&](auto i) { may &= v != corners_[plan<i>.corner]; });
    return may;
  }

  // Rule 3, unless the choice already obeyed it.
  template <std::size_t step>
  bool outer_corners_suffice() const {
    return (closes_at_first<step>() && fan_->are_all_corners_judged()) ||
           all_of_indices<plan<step>.outer_corners.size()>([&](auto i) {
             constexpr OuterCorner c = plan<step>.outer_corners[i];
             return fan_->corner_suffices(outer_edges_[c.corner][c.end], outer_edges_[c.corner][c.next_end]);
           });
  }
  // A look ahead: some quad has an outer edge that fits the one just placed.
  template <OpenCorner open>
  bool open_corner_may_suffice(std::int32_t outer_edge) const {
    const QuadFan::Pair& pair = *pairs_[open.quad];
    const std::size_t side = pair.places[0] == places_[open.corner.corner] ? 0 : 1;
    if constexpr (open.next_is_open) return fan_->may_suffice_before(outer_edge, pair, side);
    return fan_->may_suffice_after(outer_edge, pair, side);
  }
  template <std::size_t step>
  bool corners_suffice() const {
    return all_of_indices<plan<step>.corners.size()>([&](auto i) {
      if (opens_at_first<step>() && plan<step>.corners[i][0] == first) return true;  // the choice already obeyed it
      constexpr CornerEdges c = corner_edges<Topology>(plan<step>.corners[i]);
      const double determinant = det(edges_[c.edges[0]], edges_[c.edges[1]], edges_[c.edges[2]]);
      return scaled_jacobian_exceeds(c.is_turned ? -determinant : determinant,
                                     squares_[c.edges[0]] * squares_[c.edges[1]] * squares_[c.edges[2]],
                                     filter_.min_quality);
    });
  }

  // Rules 2 and 8, and the triangles of prisms and pyramids.
  template <std::size_t step>
  bool facets_close(int from_quad) {
    return all_of_indices<plan<step>.triangles.size()>([&](auto i) {
             constexpr LocalTriangle t = plan<step>.triangles[i];
             return tables_.links().is_facet(corners_[t[0]], corners_[t[1]], corners_[t[2]]);
           }) &&
           all_of_indices<plan<step>.closed_quads.size()>([&](auto i) {
             constexpr PlanQuad quad = plan<step>.closed_quads[i];
             return closes<quad, plan<step>.corner>(from_quad == quad.quad);
           });
  }

  // A look ahead: each quad with three corners has a possible fourth.
  template <std::size_t step>
  bool quads_open() {
    return all_of_indices<plan<step>.opened_quads.size()>([&](auto i) {
      constexpr PlanQuad quad = plan<step>.opened_quads[i];
      return opens<quad>();
    });
  }

  // The quads at the first corner were found and judged once for all cells there.
  template <PlanQuad quad>
  bool opens() {
    if constexpr (is_at_first(quad)) {
      pairs_[quad.quad] = fan_->find_pair(places_[quad.side], places_[quad.other_side]);
      return pairs_[quad.quad] != nullptr;
    }
    const VertexLinks& links = tables_.links();
    angles_[quad.quad] = {links, corners_[quad.corner], place_beside<quad.side, quad.corner>(),
                          place_beside<quad.other_side, quad.corner>()};
    return angles_[quad.quad].has_opposite(links);
  }

  // The place of `corner` among the neighbours of the corner `beside`.
  template <std::uint8_t corner, std::uint8_t beside>
  int place_beside() const {
    if constexpr (is_outer_edge<Topology>(beside, corner))
      return fan_->place_at_near_end(outer_edges_[beside][corner]);
    else
      return tables_.links().place_of(corners_[corner], corners_[beside]);
  }

  template <PlanQuad quad, std::uint8_t fourth>
  bool closes(bool is_from_there) {
    if constexpr (is_at_first(quad)) {
      if (is_from_there) return true;
      for (const QuadFan::Quad& found : fan_->quads_of(*pairs_[quad.quad])) {
        if (found.opposite != corners_[fourth]) continue;
        set_outer_edges<quad, fourth>(found);
        return true;
      }
      return false;
    }
    return (is_from_there || angles_[quad.quad].has_opposite(tables_.links(), corners_[fourth])) &&
           (!filter_.drop_folded ||
            has_unfolded_diagonal(tables_.mesh(), tables_.links(), corners_[quad.corner], corners_[quad.side],
                                  corners_[fourth], corners_[quad.other_side]));
  }

  template <PlanQuad quad, std::uint8_t fourth>
  void set_outer_edges(const QuadFan::Quad& found) {
    const std::size_t side = places_[quad.side] > places_[quad.other_side];
    diagonals_[quad.quad] = found.diagonals;
    outer_edges_[quad.side][fourth] = found.outer_edges[side];
    outer_edges_[quad.other_side][fourth] = found.outer_edges[1 - side];
  }

  const MeshTables& tables_;
  const QuadFilter filter_;
  Visit visit_;
  const QuadFan* fan_ = nullptr;
  CellCorners corners_{};
  CellPoints points_{};
  std::array<Vec3, Topology::edges.size()> edges_{};  // of placed corners, from the edge's first corner to its second
  std::array<double, Topology::edges.size()> squares_{};  // their squared lengths
  std::array<int, corner_count> places_{};  // of corners beside the first one: the place among its neighbours
  std::array<std::array<std::int32_t, corner_count>, corner_count> outer_edges_{};  // in the fan, by their two corners
  // By quad, once it is open: the quads that close it if it is at the first corner, or where to find them.
  std::array<const QuadFan::Pair*, Topology::quads.size()> pairs_{};
  std::array<QuadAngle, Topology::quads.size()> angles_{};
  std::array<Diagonals, Topology::quads.size()> diagonals_{};  // of closed quads at the first corner, seen from there
  std::vector<OppositeCorner> found_;
};

}  // namespace hexpipe::candidates
