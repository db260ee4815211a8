#include "tools/assemble/order/second_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/curved/nodes.hpp"
#include "common/mesh/facet_key.hpp"
#include "tools/assemble/order/boundary_edges.hpp"

namespace hexpipe::assemble::order {
namespace {

// How far from the chord's middle a place may be, in lengths of the chord: a third of a circle is 0.29 high.
constexpr double most_height = 0.3;
// How far off a curve the ends of an edge on it may be, in the same lengths.
constexpr double most_off_curve = 0.1;

class TargetFinder {
 public:
  TargetFinder(const MixedMesh& mesh, const GivenSurface* surface) : mesh_(mesh), surface_(surface) {}

  std::vector<curved::Target> run() {
    find_nodes();
    std::vector<curved::Target> targets;
    for (const BoundaryEdge& edge : boundary_edges(mesh_)) {
      if (edge.is_sharp) ++curves_;
      const Vertex node = nodes_.at(edge_key(edge.a, edge.b));
      const std::optional<Vec3> at = surface_ != nullptr ? place_on_surface(edge) : std::nullopt;
      if (surface_ != nullptr && !at) strays_.insert(node);
      targets.push_back({node, at.value_or(edge.bent)});
      places_[node] = targets.back().at;
    }
    if (surface_ != nullptr && mesh_.second_order->full) add_quads(targets);
    return targets;
  }

  std::int64_t curves() const { return curves_; }
  // Nodes that have no place on the surface.
  const std::set<Vertex>& strays() const { return strays_; }

 private:
  void find_nodes() {
    const auto each = [&](std::uint8_t vtk, const auto& block) {
      const auto edges = node_places_of(vtk).edges;
      for (std::size_t i = 0; i < block.size(); ++i)
        for (std::size_t e = 0; e < edges.size(); ++e)
          nodes_[edge_key(block.cells[i][edges[e][0]], block.cells[i][edges[e][1]])] =
              mesh_.second_order->of(vtk, i)[e];
    };
    each(vtk_code_of_triangle, mesh_.triangles);
    each(vtk_code_of_quad, mesh_.quads);
  }

  std::optional<Vec3> place_on_surface(const BoundaryEdge& edge) const {
    const Vec3 &a = mesh_.points[edge.a], &b = mesh_.points[edge.b];
    const Vec3 middle = 0.5 * (a + b), along = unit(b - a);
    const double length = norm(b - a);
    // A curve that only passes by is not the edge's.
    const auto is_on_curve = [&](const Vec3& end) {
      return surface_->on_curves(end, along, most_off_curve * length).has_value();
    };
    std::optional<Vec3> at;
    if (edge.is_sharp && is_on_curve(a) && is_on_curve(b))
      at = surface_->on_curves(middle, along, most_height * length);
    return at ? at : surface_->on_faces(middle, edge.normal, most_height * length);
  }

  void add_quads(std::vector<curved::Target>& targets) {
    for (std::size_t i = 0; i < mesh_.quads.size(); ++i) {
      const auto nodes = mesh_.second_order->of(vtk_code_of_quad, i);
      std::array<Vec3, 4> corners, edges;
      for (std::size_t k = 0; k < 4; ++k) {
        corners[k] = mesh_.points[mesh_.quads.cells[i][k]];
        edges[k] = places_.at(nodes[k]);
      }
      const Vec3 normal = unit(cross(corners[2] - corners[0], corners[3] - corners[1]));
      const double most = most_height * norm(corners[2] - corners[0]);
      if (const auto at = surface_->on_faces(curved::middle_of_quad(corners, edges), normal, most))
        targets.push_back({nodes[4], *at});
      else
        strays_.insert(nodes[4]);
    }
  }

  const MixedMesh& mesh_;
  const GivenSurface* surface_;
  std::int64_t curves_ = 0;
  std::set<Vertex> strays_;
  KeyMap<2, Vertex> nodes_;        // of the facets' edges
  std::map<Vertex, Vec3> places_;  // of these nodes
};

}  // namespace

SecondOrderCounts make_second_order(MixedMesh& mesh, bool full, const GivenSurface* surface) {
  SecondOrderCounts counts;
  curved::add_straight_nodes(mesh, full);
  counts.nodes = static_cast<std::int64_t>(mesh.points.size()) - mesh.second_order->first;
  counts.has_surface = surface != nullptr;
  TargetFinder finder(mesh, surface);
  const std::vector<curved::Target> targets = finder.run();
  counts.bending = curved::bend(mesh, targets);
  const std::set<Vertex>& strays = finder.strays();
  counts.curves = finder.curves();
  counts.strays = static_cast<std::int64_t>(strays.size());
  if (!counts.has_surface) return counts;
  // A stray may be drawn back, too.
  counts.placed = counts.bending.on_boundary - counts.strays;
  counts.placed -= std::ranges::count_if(counts.bending.drawn_back, [&](Vertex v) { return !strays.contains(v); });
  return counts;
}

nlohmann::ordered_json to_json(const SecondOrderCounts& counts) {
  const curved::BendCounts& bending = counts.bending;
  return {{"nodes", counts.nodes},
          {"corners_moved_onto_surface", counts.corners.moved},
          {"corners_off_surface", counts.corners.held},
          {"nodes_of_boundary", bending.on_boundary},
          {"nodes_of_curves", counts.curves},
          {"on_given_surface", counts.placed},
          {"too_far_from_given_surface", counts.strays},
          {"bent_cells", bending.curved_cells},
          {"bent_too_much", bending.invalid},
          {"nodes_drawn_back", bending.drawn_back.size()},
          {"nodes_on_chord_again", bending.straight},
          {"farthest_drawn_back", bending.farthest}};
}

std::string summary_line(const SecondOrderCounts& counts) {
  const curved::BendCounts& bending = counts.bending;
  return fmt::format(
      "second order: {} nodes, {} of them on the boundary; {} cells are bent, all with a Jacobian that is positive "
      "everywhere",
      counts.nodes, bending.on_boundary, bending.curved_cells);
}

}  // namespace hexpipe::assemble::order
