#include "common/curved/bend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "common/curved/curved_validity.hpp"
#include "common/curved/nodes.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/vertex_items.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::curved {
namespace {

// Rounds of spreading what bends the boundary into the mesh: about six layers of cells far.
constexpr int spreading_rounds = 40;
// Rounds of going back a part of the way; cells that are not valid then become straight.
constexpr int patient_rounds = 20;
// Steps of halving the interval of the share that is left.
constexpr int bisections = 6;
// An edge that is bent by less, in lengths of the chord, is straight: coordinates of files have errors of this size.
constexpr double straight_enough = 1e-6;

constexpr std::size_t most_nodes = 27;

struct CellPlace {
  CellKind kind;
  std::int32_t index;
};

// The place that a node is to have, if any, and how far from it it may be.
struct NodeTarget {
  const Vec3* at = nullptr;
  double tolerance = 0;
};

class Bender {
 public:
  explicit Bender(MixedMesh& mesh)
      : mesh_(mesh),
        nodes_(*mesh.second_order),
        first_(static_cast<std::size_t>(nodes_.first)),
        offset_(mesh.points.size() - first_),
        share_(offset_.size(), 1.0) {
    list_cells();
  }

  BendCounts run(std::span<const Target> targets) {
    mark_boundary();
    take_targets(targets);
    if (std::ranges::any_of(offset_, [](const Vec3& offset) { return offset != Vec3{}; })) {
      spread();
      find_curved_cells();
      draw_back();
      give_back();
      counts_.curved_cells =
          std::ranges::count_if(curved_, [&](std::int32_t c) { return !is_straight(static_cast<std::size_t>(c)); });
    }
    place_nodes();
    for (std::size_t i = 0; i < offset_.size(); ++i) count(i);
    return std::move(counts_);
  }

 private:
  std::size_t number(Vertex node) const { return static_cast<std::size_t>(node) - first_; }
  Vec3& offset(Vertex node) { return offset_[number(node)]; }

  // visit(vtk, index, corners)
  template <class Visit>
  void for_each_cell(Visit&& visit) const {
    const auto each = [&](CellKind kind, const auto& block) {
      for (std::size_t i = 0; i < block.size(); ++i) visit(static_cast<std::uint8_t>(kind), i, block.cells[i]);
    };
    each(CellKind::hex, mesh_.hexes);
    each(CellKind::prism, mesh_.prisms);
    each(CellKind::pyramid, mesh_.pyramids);
    each(CellKind::tet, mesh_.tets);
  }
  template <class Visit>
  void for_each_facet(Visit&& visit) const {
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) visit(vtk_code_of_triangle, i, mesh_.triangles.cells[i]);
    for (std::size_t i = 0; i < mesh_.quads.size(); ++i) visit(vtk_code_of_quad, i, mesh_.quads.cells[i]);
  }

  void list_cells() {
    for_each_cell([&](std::uint8_t vtk, std::size_t i, const auto&) {
      cells_.push_back({static_cast<CellKind>(vtk), static_cast<std::int32_t>(i)});
    });
    cells_at_ = VertexItems(offset_.size(), [&](auto&& visit) {
      for (std::size_t c = 0; c < cells_.size(); ++c)
        for (const Vertex node : nodes_of(c)) visit(static_cast<Vertex>(number(node)), static_cast<std::int32_t>(c));
    });
  }

  std::span<const Vertex> nodes_of(std::size_t cell) const {
    return nodes_.of(static_cast<std::uint8_t>(cells_[cell].kind), static_cast<std::size_t>(cells_[cell].index));
  }

  std::span<const Vertex> corners_of(std::size_t cell) const {
    const auto index = static_cast<std::size_t>(cells_[cell].index);
    switch (cells_[cell].kind) {
      case CellKind::hex:
        return mesh_.hexes.cells[index];
      case CellKind::prism:
        return mesh_.prisms.cells[index];
      case CellKind::pyramid:
        return mesh_.pyramids.cells[index];
      case CellKind::tet:
        break;
    }
    return mesh_.tets.cells[index];
  }

  void mark_boundary() {
    on_boundary_.assign(offset_.size(), false);
    for_each_facet([&](std::uint8_t vtk, std::size_t i, const auto&) {
      for (const Vertex node : nodes_.of(vtk, i)) on_boundary_[number(node)] = true;
    });
    counts_.on_boundary = std::ranges::count(on_boundary_, true);
  }

  // The offset of an edge's node is from the chord's middle, that of a quad's node from where the quad's bent edges put
  // it.
  void take_targets(std::span<const Target> targets) {
    target_.resize(offset_.size());
    for (const Target& t : targets)
      if (on_boundary_[number(t.node)]) target_[number(t.node)] = {&t.at, 0};
    const auto take = [&](Vertex node, const Vec3& from, double length) {
      NodeTarget& target = target_[number(node)];
      if (target.at == nullptr) return;
      target.tolerance = straight_enough * length;
      if (norm(*target.at - from) > target.tolerance) offset(node) = *target.at - from;
    };
    for_each_facet([&](std::uint8_t vtk, std::size_t i, const auto& corners) {
      const auto edges = node_places_of(vtk).edges;
      const std::span<const Vertex> nodes = nodes_.of(vtk, i);
      const auto& p = mesh_.points;
      for (std::size_t e = 0; e < edges.size(); ++e) {
        const Vec3 &a = p[corners[edges[e][0]]], &b = p[corners[edges[e][1]]];
        take(nodes[e], 0.5 * (a + b), norm(b - a));
      }
    });
    if (!nodes_.full) return;
    for (std::size_t i = 0; i < mesh_.quads.size(); ++i) {
      const std::span<const Vertex> nodes = nodes_.of(vtk_code_of_quad, i);
      std::array<Vec3, 4> at, edges;
      for (std::size_t k = 0; k < 4; ++k) at[k] = mesh_.points[mesh_.quads.cells[i][k]];
      for (std::size_t k = 0; k < 4; ++k) edges[k] = 0.5 * (at[k] + at[(k + 1) % 4]) + offset(nodes[k]);
      take(nodes[4], middle_of_quad(at, edges), norm(at[2] - at[0]));
    }
  }

  // The node of the edge inside a quad follows that of the opposite edge; in triangles there is none.
  void spread() {
    struct Pull {
      Vertex node, opposite;
    };
    std::vector<Pull> pulls;
    std::vector<double> weights(offset_.size());
    KeySet<4> quads;
    KeySet<3> triangles;
    const auto add_sides = [&]<class Topology>(Topology, std::uint8_t vtk, std::size_t i, const auto& corners) {
      const auto edges = node_places_of(vtk).edges;
      const std::span<const Vertex> nodes = nodes_.of(vtk, i);
      for (const LocalQuad& q : Topology::quads) {
        if (!quads.insert(key_of(Quad{corners[q[0]], corners[q[1]], corners[q[2]], corners[q[3]]})).second) continue;
        for (std::size_t k = 0; k < 4; ++k) {
          const Vertex node = nodes[edge_between(edges, q[k], q[(k + 1) % 4])];
          const Vertex opposite = nodes[edge_between(edges, q[(k + 2) % 4], q[(k + 3) % 4])];
          if (on_boundary_[number(node)]) continue;
          pulls.push_back({node, opposite});
          weights[number(node)] += 1;
        }
      }
      for (const LocalTriangle& t : Topology::triangles) {
        if (!triangles.insert(key_of(Triangle{corners[t[0]], corners[t[1]], corners[t[2]]})).second) continue;
        for (std::size_t k = 0; k < 3; ++k) weights[number(nodes[edge_between(edges, t[k], t[(k + 1) % 3])])] += 0.5;
      }
    };
    for_each_cell([&](std::uint8_t vtk, std::size_t i, const auto& corners) {
      with_topology(static_cast<CellKind>(vtk), [&](auto topology) { add_sides(topology, vtk, i, corners); });
    });
    std::vector<Vec3> next(offset_.size());
    for (int round = 0; round < spreading_rounds; ++round) {
      std::ranges::fill(next, Vec3{});
      for (const Pull& pull : pulls) next[number(pull.node)] += offset(pull.opposite);
      for (std::size_t i = 0; i < next.size(); ++i)
        if (!on_boundary_[i] && weights[i] > 0) offset_[i] = (1 / weights[i]) * next[i];
    }
    drop_small_offsets();
  }

  void drop_small_offsets() {
    for_each_cell([&](std::uint8_t vtk, std::size_t i, const auto& corners) {
      const auto edges = node_places_of(vtk).edges;
      const std::span<const Vertex> nodes = nodes_.of(vtk, i);
      for (std::size_t e = 0; e < edges.size(); ++e) {
        const double length = norm(mesh_.points[corners[edges[e][1]]] - mesh_.points[corners[edges[e][0]]]);
        if (norm(offset(nodes[e])) <= straight_enough * length) offset(nodes[e]) = {};
      }
    });
  }

  void find_curved_cells() {
    for (std::size_t c = 0; c < cells_.size(); ++c)
      if (std::ranges::any_of(nodes_of(c), [&](Vertex node) { return offset(node) != Vec3{}; }))
        curved_.push_back(static_cast<std::int32_t>(c));
  }

  using Nodes = std::array<Vec3, most_nodes>;

  // The corners and nodes of a cell whose nodes keep `share` of their present offsets.
  std::span<const Vec3> places(std::size_t cell, double share, Nodes& at) const {
    const std::span<const Vertex> corners = corners_of(cell), nodes = nodes_of(cell);
    const NodePlaces where = node_places_of(static_cast<std::uint8_t>(cells_[cell].kind));
    std::size_t count = 0;
    for (const Vertex v : corners) at[count++] = mesh_.points[v];
    for (std::size_t e = 0; e < where.edges.size(); ++e) {
      const std::size_t node = number(nodes[e]);
      at[count++] = 0.5 * (at[where.edges[e][0]] + at[where.edges[e][1]]) + share * share_[node] * offset_[node];
    }
    if (!nodes_.full) return std::span(at).first(count);
    for (std::size_t q = 0; q < where.quads.size(); ++q) {
      const std::size_t node = number(nodes[where.edges.size() + q]);
      std::array<Vec3, 4> quad, edges;
      for (std::size_t k = 0; k < 4; ++k) {
        quad[k] = at[where.quads[q][k]];
        edges[k] = at[corners.size() + edge_between(where.edges, where.quads[q][k], where.quads[q][(k + 1) % 4])];
      }
      at[count++] = middle_of_quad(quad, edges) + share * share_[node] * offset_[node];
    }
    if (where.has_middle) {
      const std::span<const Vec3> all(at);
      at[count] = middle_of_hex(all.first(corners.size()), all.subspan(corners.size(), where.edges.size()),
                                all.subspan(corners.size() + where.edges.size(), where.quads.size()));
      ++count;
    }
    return std::span(at).first(count);
  }

  bool is_straight(std::size_t cell) const {
    return std::ranges::all_of(
        nodes_of(cell), [&](Vertex node) { return share_[number(node)] == 0 || offset_[number(node)] == Vec3{}; });
  }

  bool is_good(std::size_t cell, double share = 1) const {
    if (share == 0 || is_straight(cell)) return true;
    Nodes straight, bent;
    const double least = least_at_corners(cells_[cell].kind, places(cell, 0, straight));
    return is_above(cells_[cell].kind, places(cell, share, bent), kept_share * least);
  }

  std::vector<std::int32_t> not_good(const std::vector<std::int32_t>& cells) const {
    std::vector<std::uint8_t> bad(cells.size());
    parallel_for(static_cast<std::int64_t>(cells.size()), 16, [&](std::int64_t i) {
      bad[static_cast<std::size_t>(i)] = !is_good(static_cast<std::size_t>(cells[static_cast<std::size_t>(i)]));
    });
    std::vector<std::int32_t> result;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (bad[i] != 0) result.push_back(cells[i]);
    return result;
  }

  // The largest share with which the cell is good, nearly.
  double good_share(std::size_t cell) const {
    double good = 0, bad = 1;
    for (int step = 0; step < bisections; ++step) {
      const double middle = 0.5 * (good + bad);
      (is_good(cell, middle) ? good : bad) = middle;
    }
    return good;
  }

  void draw_back() {
    std::vector<std::int32_t> bad = not_good(curved_);
    counts_.invalid = static_cast<std::int64_t>(bad.size());
    for (int round = 0; !bad.empty(); ++round) {
      std::vector<double> shares(bad.size());
      if (round < patient_rounds)
        parallel_for(static_cast<std::int64_t>(bad.size()), 4, [&](std::int64_t i) {
          shares[static_cast<std::size_t>(i)] = good_share(static_cast<std::size_t>(bad[static_cast<std::size_t>(i)]));
        });
      std::vector<double> next = share_;
      std::vector<std::int32_t> around;
      for (std::size_t i = 0; i < bad.size(); ++i)
        for (const Vertex node : nodes_of(static_cast<std::size_t>(bad[i]))) {
          const std::size_t n = number(node);
          next[n] = std::min(next[n], shares[i] * share_[n]);
          const auto cells = cells_at_.at(static_cast<Vertex>(n));
          around.insert(around.end(), cells.begin(), cells.end());
        }
      share_ = std::move(next);
      std::ranges::sort(around);
      around.erase(std::ranges::unique(around).begin(), around.end());
      bad = not_good(around);
    }
  }

  // One cell drew its nodes back together; some of them need not have gone so far.
  void give_back() {
    for (std::size_t i = 0; i < share_.size(); ++i) {
      if (share_[i] == 1 || offset_[i] == Vec3{}) continue;
      const auto fits = [&](double share) {
        share_[i] = share;
        return std::ranges::all_of(cells_at_.at(static_cast<Vertex>(i)),
                                   [&](std::int32_t cell) { return is_good(static_cast<std::size_t>(cell)); });
      };
      double good = share_[i], bad = 1;
      if (fits(1)) continue;
      for (int step = 0; step < bisections; ++step) {
        const double middle = 0.5 * (good + bad);
        (fits(middle) ? good : bad) = middle;
      }
      share_[i] = good;
    }
  }

  void place_nodes() {
    Nodes at;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const std::span<const Vec3> all = places(c, 1, at);
      const std::span<const Vertex> nodes = nodes_of(c);
      for (std::size_t i = 0; i < nodes.size(); ++i) mesh_.points[nodes[i]] = all[corners_of(c).size() + i];
    }
  }

  void count(std::size_t i) {
    if (target_[i].at == nullptr) return;
    // The node of a quad also moves with those of its edges.
    const double distance = norm(mesh_.points[first_ + i] - *target_[i].at);
    if (distance <= target_[i].tolerance) return;
    counts_.drawn_back.push_back(static_cast<Vertex>(first_ + i));
    if (share_[i] == 0) ++counts_.straight;
    counts_.farthest = std::max(counts_.farthest, distance);
  }

  MixedMesh& mesh_;
  const SecondOrder& nodes_;
  std::size_t first_;
  // By node: how far it is from the middle of what it lies on, and which share of that it keeps.
  std::vector<Vec3> offset_;
  std::vector<double> share_;
  std::vector<NodeTarget> target_;
  std::vector<bool> on_boundary_;
  std::vector<CellPlace> cells_;
  VertexItems cells_at_;
  std::vector<std::int32_t> curved_;
  BendCounts counts_;
};

}  // namespace

BendCounts bend(MixedMesh& mesh, std::span<const Target> targets) {
  return Bender(mesh).run(targets);
}

}  // namespace hexpipe::curved
