#include "tools/tessellate/short_edges.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/vec3.hpp"
#include "tools/tessellate/crossings.hpp"

namespace hexpipe::tessellate {
namespace {

// The longest edge without a length, as a share of the diagonal: TetGen's own limit.
constexpr double shortest_of_diagonal = 1e-8;

// Each looks at all triangles. Slivers have few edges.
constexpr int most_rounds = 32;

class Collapser {
 public:
  explicit Collapser(formats::SurfaceSoup surface) : surface_(std::move(surface)) {}

  // Whether no triangles of one body cross afterwards.
  bool run(double longest) {
    for (int round = 0; round < most_rounds; ++round) {
      const auto crossings = crossings_of_bodies(surface_);
      if (crossings.empty()) return true;
      begin_round();
      const std::size_t before = collapsed_;
      for (const auto& pair : crossings) collapse_one_of(pair, longest);
      if (collapsed_ == before) return false;
      end_round();
    }
    return false;
  }

  std::size_t collapsed() const { return collapsed_; }

  formats::SurfaceSoup take() {
    number_points();
    return std::move(surface_);
  }

 private:
  void begin_round() {
    const std::size_t points = surface_.points.size();
    triangles_at_.assign(points, {});
    for (std::size_t i = 0; i < surface_.triangles.size(); ++i)
      for (const Vertex v : surface_.triangles[i]) triangles_at_[v].push_back(i);
    curves_at_.assign(points, 0);
    for (const formats::CurveEdge& ends : surface_.curves)
      for (const Vertex v : ends) ++curves_at_[v];
    into_.resize(points);
    std::iota(into_.begin(), into_.end(), 0);
    is_touched_.assign(points, false);
  }

  // The shortest edge of the two triangles that can go, unless something around it went in this round.
  void collapse_one_of(const std::array<std::int32_t, 2>& pair, double longest) {
    std::vector<std::pair<double, std::array<Vertex, 2>>> edges;
    for (const std::int32_t i : pair) {
      const Triangle& t = surface_.triangles[i];
      for (int k = 0; k < 3; ++k) {
        const Vertex a = t[k], b = t[(k + 1) % 3];
        const double length = norm(surface_.points[a] - surface_.points[b]);
        if (length <= longest) edges.push_back({length, {std::min(a, b), std::max(a, b)}});
      }
    }
    std::ranges::sort(edges);
    for (const auto& [length, ends] : edges)
      if (!is_touched_[ends[0]] && !is_touched_[ends[1]] && can_become_a_point(ends)) return collapse(ends);
  }

  // The surface keeps its shape: what both ends are joined to are the third corners of the triangles at the edge.
  bool can_become_a_point(const std::array<Vertex, 2>& ends) const {
    std::set<Vertex> beside[2], third;
    for (int end = 0; end < 2; ++end)
      for (const std::size_t i : triangles_at_[ends[end]])
        for (const Vertex v : surface_.triangles[i]) {
          if (v == ends[0] || v == ends[1]) continue;
          beside[end].insert(v);
          if (std::ranges::count(surface_.triangles[i], ends[1 - end]) > 0) third.insert(v);
        }
    std::vector<Vertex> common;
    std::ranges::set_intersection(beside[0], beside[1], std::back_inserter(common));
    return std::ranges::equal(common, third);
  }

  // The end of more curves stays where it is.
  void collapse(std::array<Vertex, 2> ends) {
    for (const Vertex end : ends)
      for (const std::size_t i : triangles_at_[end])
        for (const Vertex v : surface_.triangles[i]) is_touched_[v] = true;
    if (curves_at_[ends[1]] > curves_at_[ends[0]]) std::swap(ends[0], ends[1]);
    into_[ends[1]] = ends[0];
    ++collapsed_;
  }

  void end_round() {
    for (Triangle& t : surface_.triangles)
      for (Vertex& v : t) v = into_[v];
    formats::renumber_curves(surface_, into_);
    drop_what_became_flat();
  }

  void drop_what_became_flat() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
      const auto& [a, b, c] = surface_.triangles[i];
      if (a == b || b == c || c == a) continue;
      surface_.triangles[kept] = surface_.triangles[i];
      surface_.tags[kept] = surface_.tags[i];
      surface_.sides[kept++] = surface_.sides[i];
    }
    surface_.triangles.resize(kept);
    surface_.tags.resize(kept);
    surface_.sides.resize(kept);
    surface_.places.resize(kept);
    KeySet<2> seen;
    formats::keep_curves_if(surface_, [&](const formats::CurveEdge& edge) { return seen.insert(key_of(edge)).second; });
  }

  // Without the points that are left over.
  void number_points() {
    std::vector<Vertex> number(surface_.points.size(), no_index);
    for (const Triangle& t : surface_.triangles)
      for (const Vertex v : t) number[v] = 0;
    std::size_t kept = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == no_index) continue;
      surface_.points[kept] = surface_.points[v];
      number[v] = static_cast<Vertex>(kept++);
    }
    surface_.points.resize(kept);
    for (Triangle& t : surface_.triangles)
      for (Vertex& v : t) v = number[v];
    formats::renumber_curves(surface_, number);
  }

  formats::SurfaceSoup surface_;
  std::size_t collapsed_ = 0;
  // Of this round, by point.
  std::vector<std::vector<std::size_t>> triangles_at_;
  std::vector<int> curves_at_;
  std::vector<Vertex> into_;
  std::vector<bool> is_touched_;
};

}  // namespace

std::size_t join_ends_without_length(std::span<const Triangle> triangles, std::span<const Vec3> nodes,
                                     JoinedSets& same) {
  if (nodes.empty()) return 0;
  const double shortest = shortest_of_diagonal * Box::around(nodes).diagonal();
  std::size_t count = 0;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = same.of(t[k]), b = same.of(t[(k + 1) % 3]);
      if (a == b || norm(nodes[b] - nodes[a]) > shortest) continue;
      same.join(a, b);
      ++count;
    }
  return count;
}

std::vector<std::array<std::int32_t, 2>> crossings_of_bodies(const formats::SurfaceSoup& surface) {
  auto pairs = crossing_triangles(surface.points, surface.triangles);
  std::erase_if(pairs, [&](const auto& pair) {
    return std::ranges::none_of(surface.sides[pair[0]], [&](std::int32_t region) {
      return region != 0 && std::ranges::find(surface.sides[pair[1]], region) != surface.sides[pair[1]].end();
    });
  });
  return pairs;
}

std::size_t collapse_short_edges(formats::SurfaceSoup& surface, double longest) {
  Collapser collapser(surface);
  if (!collapser.run(longest)) return 0;
  surface = collapser.take();
  return collapser.collapsed();
}

}  // namespace hexpipe::tessellate
