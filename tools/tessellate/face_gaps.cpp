// A gap is closed in the parameters of the face's surface, by the triangles of least area between its corners, found as
// G. Barequet and M. Sharir do (Filling gaps in the boundary of a polyhedron, 1995): the best triangles over a part of
// its border are one triangle on the first and the last corner, and the best ones over the two parts that this leaves.
// In a plane these do not overlap. Edges between them that are too far from the face are cut in the middle.

#include "tools/tessellate/face_gaps.hpp"

#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

#include "common/mesh/joined_sets.hpp"

namespace hexpipe::tessellate {
namespace {

// Time is in proportion to the third power. A gap with more corners is no tip.
constexpr std::size_t most_corners = 1000;
constexpr std::size_t most_new_nodes = 5000;
// Among triangles of one area in all, those in better shape: the cost of a triangle whose edges' squares are so many
// times its area. Corners in one line have no area at all.
constexpr double price_of_shape = 1e-6, worst_shape = 1e6;
// Faulty files have tolerances as large as faces: what they allow is bounded by so many deviations.
constexpr double most_tolerance = 4;
// Edges that begin at a wider angle form no tip.
constexpr double least_cosine_of_tip = 0.8;

using Loop = std::vector<std::int32_t>;

// The edges that triangles in gaps have to have, in their direction: those of the border without a triangle, and those
// of triangles without another one, from the other side.
class WantedEdges {
 public:
  WantedEdges(std::span<const NodeEdge> border, std::span<const Triangle> triangles) {
    for (const auto& [a, b, c] : triangles) add(a, b, -1), add(b, c, -1), add(c, a, -1);
    const std::vector<int> senses = senses_of(border);
    for (std::size_t i = 0; i < border.size(); ++i) add(border[i].first, border[i].second, senses[i]);
  }

  // The loops that they form. Edges that are left over form a loop, too, which no triangles near the face close.
  std::vector<Loop> loops() const {
    std::vector<NodeEdge> wanted;
    for (const auto& [edge, count] : count_)
      wanted.insert(wanted.end(), static_cast<std::size_t>(std::abs(count)),
                    count > 0 ? NodeEdge(edge[0], edge[1]) : NodeEdge(edge[1], edge[0]));
    std::ranges::sort(wanted);
    std::multimap<std::int32_t, std::int32_t> edges(wanted.begin(), wanted.end());
    std::vector<Loop> loops;
    while (!edges.empty()) {
      Loop path{edges.begin()->first};
      for (auto onward = edges.begin(); onward != edges.end(); onward = edges.find(path.back())) {
        const std::int32_t next = onward->second;
        edges.erase(onward);
        const auto met = std::ranges::find(path, next);
        if (met == path.end()) {
          path.push_back(next);
          continue;
        }
        loops.emplace_back(met, path.end());
        path.erase(met + 1, path.end());
      }
    }
    return loops;
  }

 private:
  // -1 for edges of wires that go the wrong way, as that of OpenCASCADE's own torus does: most of their edges are those
  // of triangles from the other side.
  std::vector<int> senses_of(std::span<const NodeEdge> border) const {
    std::map<std::int32_t, std::int32_t> number;  // of each node on the border
    for (const auto& [from, to] : border)
      for (const std::int32_t node : {from, to}) number.try_emplace(node, static_cast<std::int32_t>(number.size()));
    JoinedSets wires(number.size());
    for (const auto& [from, to] : border) wires.join(number[from], number[to]);
    std::vector<int> balance(number.size());
    for (const auto& [from, to] : border)
      if (const auto found = count_.find(edge_key(from, to)); found != count_.end())
        balance[wires.of(number[from])] += from < to ? found->second : -found->second;
    std::vector<int> senses;
    for (const auto& [from, to] : border) senses.push_back(balance[wires.of(number[from])] > 0 ? -1 : 1);
    return senses;
  }
  void add(std::int32_t from, std::int32_t to, int count) {
    if (from != to) count_[edge_key(from, to)] += from < to ? count : -count;
  }

  KeyMap<2, int> count_;
};

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length = norm_squared(along);
  const double at = length > 0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0;
  return norm(p - (a + at * along));
}

// The part of a loop in which its two sides, from a corner on, are no further apart than `reach`.
class Tip {
 public:
  Tip(const Loop& loop, std::size_t corner, const std::vector<Vec3>& nodes, double reach)
      : loop_(loop), corner_(corner), nodes_(nodes), reach_(reach) {
    const Vec3 first = next(0) - at_corner(), second = next(1) - at_corner();
    if (dot(first, second) < least_cosine_of_tip * norm(first) * norm(second)) return;
    // One node at least stays beyond the tip.
    while (counts_[0] + counts_[1] + 2 < loop.size()) {
      const std::size_t nearer = distance(0) <= distance(1) ? 0 : 1;
      if (!is_near_other_side(nearer)) break;
      ++counts_[nearer];
    }
  }

  // The nodes of the side that has more of them move to the nearest ones of the other side, or of the corner.
  void append_joins(std::vector<NodeEdge>& joins) const {
    const std::size_t finer = counts_[0] > counts_[1] ? 0 : 1;
    for (std::size_t i = 0; i < counts_[finer]; ++i) {
      const std::int32_t node = node_of(finer, i);
      std::int32_t nearest = loop_[corner_];
      for (std::size_t k = 0; k < counts_[1 - finer]; ++k)
        if (const std::int32_t other = node_of(1 - finer, k);
            norm_squared(nodes_[other] - nodes_[node]) < norm_squared(nodes_[nearest] - nodes_[node]))
          nearest = other;
      joins.emplace_back(node, nearest);
    }
  }

 private:
  // From the corner on: side 0 goes along the loop, side 1 against it.
  std::int32_t node_of(std::size_t side, std::size_t i) const {
    const std::size_t n = loop_.size();
    return loop_[(side == 0 ? corner_ + 1 + i : corner_ + n - 1 - i) % n];
  }
  const Vec3& at_corner() const { return nodes_[loop_[corner_]]; }
  const Vec3& next(std::size_t side) const { return nodes_[node_of(side, counts_[side])]; }
  double distance(std::size_t side) const { return norm_squared(next(side) - at_corner()); }
  bool is_near_other_side(std::size_t side) const {
    const std::size_t other = 1 - side;
    Vec3 from = at_corner();
    for (std::size_t k = 0; k <= counts_[other]; ++k) {
      const Vec3& to = nodes_[node_of(other, k)];
      if (distance_to_segment(next(side), from, to) <= reach_) return true;
      from = to;
    }
    return false;
  }

  const Loop& loop_;
  std::size_t corner_;
  const std::vector<Vec3>& nodes_;
  double reach_;
  std::array<std::size_t, 2> counts_{0, 0};  // how many nodes of each side belong to the tip
};

// What is left of the loop when nodes are joined: steps from a node to itself go, and steps to and fro.
Loop joined(const Loop& loop, std::span<const NodeEdge> joins) {
  std::map<std::int32_t, std::int32_t> into(joins.begin(), joins.end());
  Loop result;
  const auto push = [&](std::int32_t node) {
    if (!result.empty() && result.back() == node) return;
    if (result.size() > 1 && result[result.size() - 2] == node)
      result.pop_back();
    else
      result.push_back(node);
  };
  for (const std::int32_t node : loop) push(into.contains(node) ? into.at(node) : node);
  while (result.size() > 1 && (result.front() == result.back() || result[1] == result.back())) {
    const bool is_twice = result.front() == result.back();
    result.pop_back();
    if (!is_twice) result.erase(result.begin());
  }
  return result;
}

// A corner of a gap: its parameters, in units of length, and its node.
struct GapCorner {
  std::int32_t node;
  double x, y;
};

class LoopFiller {
 public:
  LoopFiller(const std::vector<GapCorner>& loop, const std::vector<Vec3>& nodes)
      : loop_(loop), nodes_(nodes), best_(loop.size() * loop.size()) {
    const std::size_t n = loop.size();
    for (std::size_t span = 2; span < n; ++span)
      for (std::size_t first = 0; first + span < n; ++first) choose(first, first + span);
  }

  // By the numbers of corners.
  std::vector<std::array<std::size_t, 3>> triangles() const {
    std::vector<std::array<std::size_t, 3>> result;
    std::vector<std::pair<std::size_t, std::size_t>> parts{{0, loop_.size() - 1}};
    while (!parts.empty()) {
      const auto [first, last] = parts.back();
      parts.pop_back();
      if (last - first < 2) continue;
      const std::size_t apex = best(first, last).apex;
      result.push_back({first, apex, last});
      parts.emplace_back(first, apex);
      parts.emplace_back(apex, last);
    }
    return result;
  }

 private:
  struct Choice {
    double cost = 0;
    std::size_t apex = 0;
  };

  const Choice& best(std::size_t first, std::size_t last) const { return best_[first * loop_.size() + last]; }

  void choose(std::size_t first, std::size_t last) {
    Choice least{std::numeric_limits<double>::infinity(), first};
    for (std::size_t apex = first + 1; apex < last; ++apex) {
      const double cost = best(first, apex).cost + best(apex, last).cost + cost_of(first, apex, last);
      if (cost < least.cost) least = {cost, apex};
    }
    best_[first * loop_.size() + last] = least;
  }

  double cost_of(std::size_t i, std::size_t j, std::size_t k) const {
    const auto &a = loop_[i], &b = loop_[j], &c = loop_[k];
    const auto squared = [&](const GapCorner& from, const GapCorner& to) {
      return norm_squared(nodes_[to.node] - nodes_[from.node]);
    };
    const double area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    const double lengths = squared(a, b) + squared(b, c) + squared(c, a);
    return area + price_of_shape * lengths * (lengths < worst_shape * area ? lengths / area : worst_shape);
  }

  const std::vector<GapCorner>& loop_;
  const std::vector<Vec3>& nodes_;
  std::vector<Choice> best_;  // by first and last corner
};

double tolerance_of_edges(const TopoDS_Face& face) {
  double tolerance = 0;
  for (TopExp_Explorer part(face, TopAbs_EDGE); part.More(); part.Next())
    tolerance = std::max(tolerance, BRep_Tool::Tolerance(TopoDS::Edge(part.Current())));
  return tolerance;
}

class GapFiller {
 public:
  GapFiller(const TopoDS_Face& face, const std::vector<Vec3>& nodes, double deviation)
      : surface_(BRep_Tool::Surface(face)),
        given_(nodes.size()),
        nodes_(nodes),
        tolerance_(std::min(tolerance_of_edges(face), most_tolerance * deviation)),
        reach_(deviation + tolerance_) {}

  // False if no triangles near the face close the loop.
  bool fill(const Loop& loop) {
    if (loop.size() > most_corners) return false;
    const std::size_t first_join = filled_.joins.size();
    for (std::size_t corner = 0; corner < loop.size() && filled_.joins.size() == first_join; ++corner)
      Tip(loop, corner, nodes_, 2 * tolerance_).append_joins(filled_.joins);
    const Loop left = joined(loop, std::span(filled_.joins).subspan(first_join));
    if (left.size() < 3) return true;
    if (!find_parameters(left)) return false;
    const std::vector<GapCorner> corners = corners_of(left);
    std::vector<Triangle> triangles;
    for (const auto& [a, b, c] : LoopFiller(corners, nodes_).triangles())
      triangles.push_back({left[a], left[b], left[c]});
    if (!refine(triangles)) return false;
    filled_.triangles.insert(filled_.triangles.end(), triangles.begin(), triangles.end());
    return true;
  }

  FilledGaps result() {
    filled_.nodes.assign(nodes_.begin() + static_cast<std::ptrdiff_t>(given_), nodes_.end());
    return std::move(filled_);
  }

 private:
  // Of all nodes of the loop, so that they go on without a jump where the surface is periodic. False if they do not
  // come back to the first.
  bool find_parameters(const Loop& loop) {
    const Handle(Geom_Surface) surface = surface_.Surface();
    const auto go_on = [&](const gp_Pnt2d& before, gp_Pnt2d next) {
      if (surface->IsUPeriodic())
        next.SetX(next.X() + surface->UPeriod() * std::round((before.X() - next.X()) / surface->UPeriod()));
      if (surface->IsVPeriodic())
        next.SetY(next.Y() + surface->VPeriod() * std::round((before.Y() - next.Y()) / surface->VPeriod()));
      return next;
    };
    gp_Pnt2d at;
    for (const std::int32_t node : loop) {
      const gp_Pnt p(nodes_[node].x, nodes_[node].y, nodes_[node].z);
      at = node == loop.front() ? surface_.ValueOfUV(p, tolerance_)
                                : go_on(at, surface_.NextValueOfUV(at, p, tolerance_));
      if (surface_.Gap() > reach_) return false;
      parameters_[node] = at;
    }
    const gp_Pnt2d first = parameters_[loop.front()];
    return first.Distance(go_on(at, first)) == 0;
  }

  std::vector<GapCorner> corners_of(const Loop& loop) {
    gp_Pnt at;
    gp_Vec along_u, along_v;
    const gp_Pnt2d& first = parameters_[loop.front()];
    surface_.Surface()->D1(first.X(), first.Y(), at, along_u, along_v);
    std::vector<GapCorner> corners;
    for (const std::int32_t node : loop)
      corners.push_back(
          {node, along_u.Magnitude() * parameters_[node].X(), along_v.Magnitude() * parameters_[node].Y()});
    return corners;
  }

  Vec3 on_surface(const gp_Pnt2d& parameters) {
    const gp_Pnt p = surface_.Value(parameters);
    return {p.X(), p.Y(), p.Z()};
  }

  // How far a point is from the surface's tangent plane at a place near it. Along the plane it may be further away:
  // parameters do not go on like lengths.
  double distance_from(const gp_Pnt2d& place, const Vec3& point) {
    gp_Pnt at;
    gp_Vec along_u, along_v;
    surface_.Surface()->D1(place.X(), place.Y(), at, along_u, along_v);
    const gp_Vec offset(at, gp_Pnt(point.x, point.y, point.z)), normal = along_u.Crossed(along_v);
    const double length = normal.Magnitude();
    return length > 0 ? std::abs(offset.Dot(normal)) / length : offset.Magnitude();
  }

  // Cuts inner edges whose middle is too far from the face; false if triangles stay too far from it.
  bool refine(std::vector<Triangle>& triangles) {
    using Edge = VertexKey<2>;
    KeyMap<2, std::vector<std::size_t>> at_edge;
    const auto for_edges = [&](std::size_t t, auto&& visit) {
      for (std::size_t k = 0; k < 3; ++k) visit(edge_key(triangles[t][k], triangles[t][(k + 1) % 3]));
    };
    // The longest first, so that triangles stay in shape.
    std::priority_queue<std::pair<double, Edge>> queue;
    const auto link = [&](std::size_t t) {
      for_edges(t, [&](const Edge& edge) {
        at_edge[edge].push_back(t);
        queue.emplace(norm_squared(nodes_[edge[1]] - nodes_[edge[0]]), edge);
      });
    };
    const auto unlink = [&](std::size_t t) { for_edges(t, [&](const Edge& edge) { std::erase(at_edge[edge], t); }); };
    for (std::size_t t = 0; t < triangles.size(); ++t) link(t);
    while (!queue.empty()) {
      const Edge edge = queue.top().second;
      queue.pop();
      const std::vector<std::size_t> beside = at_edge[edge];
      if (beside.size() != 2) continue;
      const gp_Pnt2d between((parameters_[edge[0]].XY() + parameters_[edge[1]].XY()) / 2);
      if (distance_from(between, 0.5 * (nodes_[edge[0]] + nodes_[edge[1]])) <= reach_) continue;
      if (nodes_.size() - given_ >= most_new_nodes) return false;
      const auto node = static_cast<std::int32_t>(nodes_.size());
      nodes_.push_back(on_surface(between));
      parameters_[node] = between;
      for (const std::size_t t : beside) {
        unlink(t);
        Triangle other = triangles[t];
        std::ranges::replace(triangles[t], edge[0], node);
        std::ranges::replace(other, edge[1], node);
        triangles.push_back(other);
        link(t);
        link(triangles.size() - 1);
      }
    }
    return std::ranges::all_of(triangles, [&](const Triangle& t) {
      const gp_Pnt2d between((parameters_[t[0]].XY() + parameters_[t[1]].XY() + parameters_[t[2]].XY()) / 3);
      return distance_from(between, (1.0 / 3) * (nodes_[t[0]] + nodes_[t[1]] + nodes_[t[2]])) <= reach_;
    });
  }

  ShapeAnalysis_Surface surface_;
  std::size_t given_;  // how many nodes there were
  std::vector<Vec3> nodes_;
  std::map<std::int32_t, gp_Pnt2d> parameters_;  // on the surface
  double tolerance_, reach_;
  FilledGaps filled_;
};

}  // namespace

FilledGaps fill_gaps(const TopoDS_Face& face, std::span<const NodeEdge> border, std::span<const Triangle> triangles,
                     const std::vector<Vec3>& nodes, double deviation) {
  const std::vector<Loop> loops = WantedEdges(border, triangles).loops();
  if (loops.empty()) return {};
  GapFiller filler(face, nodes, deviation);
  for (const Loop& loop : loops)
    if (!filler.fill(loop)) return {{}, {}, {}, false, nodes[loop.front()]};
  return filler.result();
}

}  // namespace hexpipe::tessellate
