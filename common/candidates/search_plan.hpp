#pragma once
// The search for cells as a plan: the order in which corners are placed, where each new corner is sought, and what can
// be tested as soon as it is placed. Everything follows from the topology table of a cell and that order.
//
// J. Pellerin, A. Johnen, K. Verhetsel, J.-F. Remacle: Identifying combinations of tetrahedra into hexahedra: a vertex
// based strategy (IMR 2017). They take a corner from the intersection of its neighbours' neighbourhoods and test its
// quads afterwards. Here a corner comes from the quads that it closes, and the vertices that can close a quad are found
// once, when its third corner is placed.

#include <array>
#include <cstdint>
#include <optional>

#include "common/candidates/rotations.hpp"
#include "common/mesh/cell_topology.hpp"

namespace hexpipe::candidates {

// A list with enough room for a step of any cell.
template <class T, std::size_t Most>
struct ShortList {
  std::array<T, Most> items{};
  std::size_t count = 0;

  constexpr void add(const T& item) { items[count++] = item; }
  constexpr std::size_t size() const { return count; }
  constexpr const T& operator[](std::size_t i) const { return items[i]; }
};

// A quad of the plan that lacks one corner: the one opposite `corner`, between the two sides.
struct PlanQuad {
  std::uint8_t quad;  // number in the topology
  std::uint8_t corner, side, other_side;
};

// A corner beside the first one whose two other edges are outer edges (quads.hpp). They follow the edge to the first
// corner in the positive sense.
struct OuterCorner {
  std::uint8_t corner, end, next_end;
};

// An outer corner that lacks one of its outer edges; the edge will come from a quad in which the first corner is
// opposite.
struct OpenCorner {
  OuterCorner corner;
  bool next_is_open = false;  // the missing edge is the one to next_end
  std::uint8_t quad = 0;      // number in the topology
};

// How to find one corner. All other corners named here are placed already.
struct SearchStep {
  std::uint8_t corner = 0;
  bool is_beside_first = false;      // an edge joins it to the first corner
  ShortList<std::uint8_t, 4> edges;  // numbers in the topology; they lead to corners placed before
  ShortList<std::uint8_t, 8>
      greater;  // its vertex has to be greater than theirs, so that each cell is found under one labelling
  ShortList<PlanQuad, 3> opened_quads;  // it is the third corner of these
  ShortList<PlanQuad, 3> closed_quads;  // it is the fourth corner of these
  ShortList<LocalTriangle, 4> triangles;
  ShortList<LocalCorner, 4> corners;        // corners whose edges are all placed now, except
  ShortList<OuterCorner, 3> outer_corners;  // those beside the first corner that have two outer edges
  ShortList<OpenCorner, 3> open_corners;    // outer corners, one of whose outer edges is placed now
};

// The order in which corners are placed.
template <class Topology>
inline constexpr std::array<std::uint8_t, Topology::corner_count> placement_order{};
template <>
inline constexpr std::array<std::uint8_t, 8> placement_order<HexTopology>{0, 1, 3, 4, 2, 5, 7, 6};
template <>
inline constexpr std::array<std::uint8_t, 6> placement_order<PrismTopology>{0, 1, 2, 3, 4, 5};
template <>
inline constexpr std::array<std::uint8_t, 5> placement_order<PyramidTopology>{0, 1, 3, 4, 2};

// The edges at a corner, as the topology lists them, and whether their directions turn the determinant's sign.
struct CornerEdges {
  std::array<std::uint8_t, 3> edges{};
  bool is_turned = false;
};

template <class Topology>
constexpr CornerEdges corner_edges(const LocalCorner& corner) {
  CornerEdges result;
  for (std::size_t i = 0; i < 3; ++i)
    // NOLINTNEXTLINE(bugprone-too-small-loop-variable): a dozen at most
    for (std::uint8_t number = 0; number < Topology::edges.size(); ++number) {
      const auto& [from, to] = Topology::edges[number];
      if ((from != corner[0] || to != corner[1 + i]) && (to != corner[0] || from != corner[1 + i])) continue;
      result.edges[i] = number;
      result.is_turned = result.is_turned != (to == corner[0]);
    }
  return result;
}

template <class Topology>
inline constexpr std::uint8_t first_corner = placement_order<Topology>[0];

// Whether some quad has the first corner and, opposite to it, the other end.
template <class Topology>
constexpr bool is_outer_edge(std::uint8_t near_end, std::uint8_t end) {
  for (const LocalQuad& q : Topology::quads)
    for (std::size_t i = 0; i < 4; ++i)
      if (q[i] == first_corner<Topology> && q[(i + 2) % 4] == end &&
          (q[(i + 1) % 4] == near_end || q[(i + 3) % 4] == near_end))
        return true;
  return false;
}

namespace plan_details {

template <class Topology>
using Placed = std::array<bool, Topology::corner_count>;

// Whether all corners of a facet or of a LocalCorner are placed, with `corner` among them.
template <class Topology, class Corners>
constexpr bool completed_by(const Corners& corners, std::uint8_t corner, const Placed<Topology>& placed) {
  bool among = false;
  for (const std::uint8_t c : corners) {
    if (!placed[c]) return false;
    among = among || c == corner;
  }
  return among;
}

// The quad in which this corner is opposite the first one, beside `side`.
template <class Topology>
constexpr std::uint8_t quad_to(std::uint8_t opposite, std::uint8_t side) {
  for (std::size_t number = 0; number < Topology::quads.size(); ++number)
    for (std::size_t i = 0; i < 4; ++i) {
      const LocalQuad& q = Topology::quads[number];
      if (q[i] == opposite && q[(i + 2) % 4] == first_corner<Topology> &&
          (q[(i + 1) % 4] == side || q[(i + 3) % 4] == side))
        return static_cast<std::uint8_t>(number);
    }
  return 0;
}

template <class Topology>
constexpr std::optional<OuterCorner> as_outer_corner(const LocalCorner& corner) {
  for (std::size_t i = 0; i < 3; ++i) {
    const OuterCorner outer{corner[0], corner[1 + (i + 1) % 3], corner[1 + (i + 2) % 3]};
    if (corner[1 + i] == first_corner<Topology> && is_outer_edge<Topology>(outer.corner, outer.end) &&
        is_outer_edge<Topology>(outer.corner, outer.next_end))
      return outer;
  }
  return std::nullopt;
}

// Each cell is found under the labelling that is least in placement order: the vertex of each corner is the least of
// those that rotations put in its place while the corners before it stay.
template <class Topology>
constexpr void order_against_rotations(std::array<SearchStep, Topology::corner_count>& plan) {
  constexpr auto& order = placement_order<Topology>;
  for (const auto& rotation : rotations_of<Topology>()) {
    std::size_t first = 0;
    while (first < order.size() && rotation[order[first]] == order[first]) ++first;
    if (first == order.size()) continue;
    for (auto& step : plan) {
      if (step.corner != rotation[order[first]]) continue;
      bool known = false;
      for (std::size_t i = 0; i < step.greater.size(); ++i) known = known || step.greater[i] == order[first];
      if (!known) step.greater.add(order[first]);
    }
  }
}

}  // namespace plan_details

template <class Topology>
constexpr auto make_search_plan() {
  std::array<SearchStep, Topology::corner_count> plan;
  plan_details::Placed<Topology> placed{};
  for (std::size_t s = 0; s < plan.size(); ++s) {
    SearchStep& step = plan[s];
    const std::uint8_t corner = step.corner = placement_order<Topology>[s];
    placed[corner] = true;

    // NOLINTNEXTLINE(bugprone-too-small-loop-variable): a dozen at most
    for (std::uint8_t number = 0; number < Topology::edges.size(); ++number) {
      const LocalEdge& e = Topology::edges[number];
      if (!plan_details::completed_by<Topology>(e, corner, placed)) continue;
      step.edges.add(number);
      step.is_beside_first = step.is_beside_first || e[0] == plan[0].corner || e[1] == plan[0].corner;
    }
    for (const LocalTriangle& t : Topology::triangles)
      if (plan_details::completed_by<Topology>(t, corner, placed)) step.triangles.add(t);
    // NOLINTNEXTLINE(bugprone-too-small-loop-variable): a dozen at most
    for (std::uint8_t number = 0; number < Topology::quads.size(); ++number)
      for (std::size_t i = 0; i < 4; ++i) {
        const LocalQuad& q = Topology::quads[number];
        const PlanQuad quad{number, q[(i + 2) % 4], q[(i + 1) % 4], q[(i + 3) % 4]};
        const std::array<std::uint8_t, 3> three{quad.corner, quad.side, quad.other_side};
        if (q[i] == corner && placed[three[0]] && placed[three[1]] && placed[three[2]]) step.closed_quads.add(quad);
        if (!placed[q[i]] && plan_details::completed_by<Topology>(three, corner, placed)) step.opened_quads.add(quad);
      }
    for (const LocalCorner& c : Topology::corners) {
      const auto open = plan_details::as_outer_corner<Topology>(c);
      if (open && (open->end == corner && !placed[open->next_end]))
        step.open_corners.add({*open, true, plan_details::quad_to<Topology>(open->next_end, open->corner)});
      if (open && (open->next_end == corner && !placed[open->end]))
        step.open_corners.add({*open, false, plan_details::quad_to<Topology>(open->end, open->corner)});
      if (!plan_details::completed_by<Topology>(c, corner, placed)) continue;
      if (const auto outer = plan_details::as_outer_corner<Topology>(c))
        step.outer_corners.add(*outer);
      else
        step.corners.add(c);
    }
  }
  plan_details::order_against_rotations<Topology>(plan);
  return plan;
}

template <class Topology>
inline constexpr auto search_plan = make_search_plan<Topology>();

}  // namespace hexpipe::candidates
