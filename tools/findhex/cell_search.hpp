#pragma once
// The search for all cells of one kind: rules 1 to 4 of ALGORITHMS.md 1, along the plan of search_plan.hpp.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "common/mesh/quality.hpp"
#include "tools/findhex/mesh_tables.hpp"
#include "tools/findhex/quad_table.hpp"
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

  CellSearch(const MeshTables& tables, const QuadTable& quads, double min_quality, Visit visit)
      : tables_(tables), quads_(quads), min_quality_(min_quality), visit_(std::move(visit)) {}

  // Visits the cells whose corner 0 is this vertex: all quads are in the table, all triangles are facets, and the
  // scaled Jacobian of every corner exceeds min_quality. Each cell has one labelling under which it is visited.
  void visit_cells_at(Vertex corner_0) {
    set<0>(corner_0);
    place<1>();
  }

 private:
  template <std::size_t step>
  static constexpr const SearchStep& plan = search_plan<Topology>[step];

  template <std::size_t step>
  void place() {
    if constexpr (step == corner_count) {
      visit_(corners_, points_);
    } else {
      for (const Vertex v : places<step>()) {
        if (!may_stand<step>(v)) continue;
        set<step>(v);
        if (corners_suffice<step>() && facets_exist<step>()) place<step + 1>();
      }
    }
  }

  template <std::size_t step>
  void set(Vertex v) {
    corners_[plan<step>.corner] = v;
    points_[plan<step>.corner] = tables_.mesh().points[v];
  }

  // The vertices that may take the place of the new corner. Every edge of a cell is a side of one of its facets, so
  // that rule 1 follows from rule 2 and from the facets.
  template <std::size_t step>
  std::span<const Vertex> places() const {
    if constexpr (plan<step>.closed_quads.size() > 0) {
      return opposites(plan<step>.closed_quads[0]);
    } else {
      return tables_.adjacency().neighbours_of(corners_[plan<step>.neighbour]);
    }
  }

  std::span<const Vertex> opposites(const OpenQuad& quad) const {
    return quads_.opposites(corners_[quad.corner], corners_[quad.side], corners_[quad.other_side]);
  }

  // One labelling of each cell, and no vertex twice.
  template <std::size_t step>
  bool may_stand(Vertex v) const {
    return all_of_indices<plan<step>.greater.size()>([&](auto i) { return v > corners_[plan<step>.greater[i]]; }) &&
           all_of_indices<step>([&](auto i) { return v != corners_[plan<i>.corner]; });
  }

  // Rule 3.
  template <std::size_t step>
  bool corners_suffice() const {
    return all_of_indices<plan<step>.corners.size()>([&](auto i) {
      constexpr LocalCorner c = plan<step>.corners[i];
      const Vec3& o = points_[c[0]];
      return scaled_jacobian_exceeds(points_[c[1]] - o, points_[c[2]] - o, points_[c[3]] - o, min_quality_);
    });
  }

  // Rule 2, the triangles of prisms and pyramids, and a look ahead: there is a fourth corner for each quad with three.
  template <std::size_t step>
  bool facets_exist() const {
    const Vertex v = corners_[plan<step>.corner];
    return all_of_indices<plan<step>.triangles.size()>([&](auto i) {
             constexpr LocalTriangle t = plan<step>.triangles[i];
             return tables_.facets().has(corners_[t[0]], corners_[t[1]], corners_[t[2]]);
           }) &&
           all_of_indices<plan<step>.closed_quads.size()>([&](auto i) {
             if constexpr (i == 0) return true;  // v comes from there
             const auto fourths = opposites(plan<step>.closed_quads[i]);
             return std::find(fourths.begin(), fourths.end(), v) != fourths.end();
           }) &&
           all_of_indices<plan<step>.opened_quads.size()>(
               [&](auto i) { return !opposites(plan<step>.opened_quads[i]).empty(); });
  }

  const MeshTables& tables_;
  const QuadTable& quads_;
  const double min_quality_;
  Visit visit_;
  CellCorners corners_{};
  CellPoints points_{};
};

}  // namespace hexpipe
