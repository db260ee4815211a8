#pragma once
// The search for all cells of one kind: rules 1 to 3 and 8 of docs/definitions.md 1, along the plan of search_plan.hpp.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/findhex/mesh_tables.hpp"
#include "tools/findhex/quads.hpp"
#include "tools/findhex/search_plan.hpp"

namespace hexpipe {

// body(std::integral_constant) for 0 .. count - 1, at compile time.
template <std::size_t count, class Body>
constexpr bool all_of_indices(Body&& body) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return (body(std::integral_constant<std::size_t, i>{}) && ...);
  }
  (std::make_index_sequence<count>{});
}

// Visit: called as visit(corners, points) with arrays of a cell's vertices and their points, in the numbering of
// Topology.
template <class Topology, class Visit>
class CellSearch {
 public:
  static constexpr std::size_t corner_count = Topology::corner_count;
  using CellCorners = std::array<Vertex, corner_count>;
  using CellPoints = std::array<Vec3, corner_count>;

  CellSearch(const MeshTables& tables, const QuadFilter& filter, Visit visit)
      : tables_(tables), filter_(filter), visit_(std::move(visit)) {}

  // Visits the cells whose corner 0 is this vertex, of which `fan` has the quads: all quads and triangles are there,
  // and the scaled Jacobian of every corner exceeds the least quality. Each cell has one labelling under which it is
  // visited.
  void visit_cells_at(Vertex corner_0, const QuadFan& fan) {
    fan_ = &fan;
    set<0>(corner_0);
    place<1>();
  }

 private:
  template <std::size_t step>
  static constexpr const SearchStep& plan = search_plan<Topology>[step];
  static constexpr std::uint8_t first = search_plan<Topology>[0].corner;

  template <std::size_t step>
  void place() {
    if constexpr (step == corner_count) {
      visit_(corners_, points_);
    } else {
      for_each_choice<step>([&](Vertex v) {
        if (!may_stand<step>(v)) return;
        set<step>(v);
        if (corners_suffice<step>() && facets_exist<step>()) place<step + 1>();
      });
    }
  }

  template <std::size_t step>
  void set(Vertex v) {
    constexpr std::uint8_t corner = plan<step>.corner;
    corners_[corner] = v;
    points_[corner] = tables_.mesh().points[v];
    all_of_indices<plan<step>.edges.size()>([&](auto i) {
      constexpr std::uint8_t edge = plan<step>.edges[i];
      edges_[edge] = points_[Topology::edges[edge][1]] - points_[Topology::edges[edge][0]];
      squares_[edge] = norm_squared(edges_[edge]);
      return true;
    });
  }

  // The vertices that may take the place of the new corner. Every edge of a cell is a side of one of its facets, so
  // that rule 1 follows from rule 2 and from the facets.
  template <std::size_t step, class Body>
  void for_each_choice(Body&& body) {
    if constexpr (plan<step>.closed_quads.size() > 0) {
      constexpr OpenQuad quad = plan<step>.closed_quads[0];
      for (const Vertex v : fourths_of<quad.quad, quad.corner>()) body(v);
    } else if constexpr (opens_at_first<step>()) {
      constexpr OpenQuad quad = plan<step>.opened_quads[0];
      constexpr std::uint8_t other = quad.side == plan<step>.corner ? quad.other_side : quad.side;
      const auto neighbours = tables_.links().neighbours_of(corners_[first]);
      for (const QuadFan::Partner& partner : fan_->partners_of(places_[other])) {
        places_[plan<step>.corner] = partner.place;
        body(neighbours[partner.place]);
      }
    } else {
      static_assert(plan<step>.is_beside_first);
      const auto neighbours = tables_.links().neighbours_of(corners_[first]);
      for (std::size_t place = 0; place < neighbours.size(); ++place) {
        places_[plan<step>.corner] = static_cast<int>(place);
        body(neighbours[place]);
      }
    }
  }

  // The new corner is beside the first one in a quad.
  template <std::size_t step>
  static constexpr bool opens_at_first() {
    return plan<step>.opened_quads.size() > 0 && plan<step>.opened_quads[0].corner == first;
  }

  // One labelling of each cell, and no vertex twice. All is compared: a branch for each would cost more.
  template <std::size_t step>
  bool may_stand(Vertex v) const {
    bool may = true;
    all_of_indices<plan<step>.greater.size()>([&](auto i) {
      may &= v > corners_[plan<step>.greater[i]];
      return true;
    });
    all_of_indices<step>([&](auto i) {
      may &= v != corners_[plan<i>.corner];
      return true;
    });
    return may;
  }

  // Rule 3.
  template <std::size_t step>
  bool corners_suffice() const {
    return all_of_indices<plan<step>.corners.size()>([&](auto i) {
      constexpr CornerEdges c = corner_edges<Topology>(plan<step>.corners[i]);
      const double determinant = det(edges_[c.edges[0]], edges_[c.edges[1]], edges_[c.edges[2]]);
      return scaled_jacobian_exceeds(c.is_turned ? -determinant : determinant,
                                     squares_[c.edges[0]] * squares_[c.edges[1]] * squares_[c.edges[2]],
                                     filter_.min_quality);
    });
  }

  // Rules 2 and 8, the triangles of prisms and pyramids, and a look ahead: there is a fourth corner for each quad with
  // three.
  template <std::size_t step>
  bool facets_exist() {
    return all_of_indices<plan<step>.triangles.size()>([&](auto i) {
             constexpr LocalTriangle t = plan<step>.triangles[i];
             return tables_.links().is_facet(corners_[t[0]], corners_[t[1]], corners_[t[2]]);
           }) &&
           all_of_indices<plan<step>.closed_quads.size()>([&](auto i) {
             constexpr OpenQuad quad = plan<step>.closed_quads[i];
             return closes(quad, corners_[plan<step>.corner], i == 0);
           }) &&
           all_of_indices<plan<step>.opened_quads.size()>([&](auto i) {
             constexpr OpenQuad quad = plan<step>.opened_quads[i];
             return open(quad);
           });
  }

  // Whether there is a fourth corner. The quads at the first corner have been found and judged for all cells there.
  bool open(const OpenQuad& quad) {
    if (quad.corner == first) {
      fourths_[quad.quad] = fan_->opposites(places_[quad.side], places_[quad.other_side]);
      return !fourths_[quad.quad].empty();
    }
    const VertexLinks& links = tables_.links();
    const Vertex corner = corners_[quad.corner];
    angles_[quad.quad] = {links, corner, links.place_of(corners_[quad.side], corner),
                          links.place_of(corners_[quad.other_side], corner)};
    return angles_[quad.quad].has_opposite(links);
  }

  template <std::uint8_t quad, std::uint8_t corner>
  std::span<const Vertex> fourths_of() {
    if constexpr (corner != first) {
      angles_[quad].find_opposites(tables_.links(), found_);
      fourths_[quad] = found_;
    }
    return fourths_[quad];
  }

  bool closes(const OpenQuad& quad, Vertex fourth, bool is_from_there) const {
    if (quad.corner == first) {
      const auto fourths = fourths_[quad.quad];
      return is_from_there || std::find(fourths.begin(), fourths.end(), fourth) != fourths.end();
    }
    return (is_from_there || angles_[quad.quad].has_opposite(tables_.links(), fourth)) &&
           (!filter_.drop_folded || has_unfolded_diagonal(tables_.mesh(), tables_.links(), corners_[quad.corner],
                                                          corners_[quad.side], fourth, corners_[quad.other_side]));
  }

  const MeshTables& tables_;
  const QuadFilter filter_;
  Visit visit_;
  const QuadFan* fan_ = nullptr;
  CellCorners corners_{};
  CellPoints points_{};
  std::array<Vec3, Topology::edges.size()> edges_{};  // from their first corner to their second, of those that stand
  std::array<double, Topology::edges.size()> squares_{};  // of their lengths
  std::array<int, corner_count>
      places_{};  // among the neighbours of the first corner, of those that an edge joins to it
  // By quad, once it is open: what closes it, found before at the first corner; or where that is to be found.
  std::array<std::span<const Vertex>, Topology::quads.size()> fourths_{};
  std::array<QuadAngle, Topology::quads.size()> angles_{};
  std::vector<Vertex> found_;
};

}  // namespace hexpipe
