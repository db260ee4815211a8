
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/joined_sets.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/solid/borders.hpp"
#include "tools/tetmesh/solid/repair_steps.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

using formats::SurfaceSoup;
using geometry::HalfEdge;
using Patch = std::set<std::int32_t>;  // triangles

// More are no few triangles. Filling takes time with the cube of the border.
constexpr std::size_t most_pairs = 1000, most_of_patch = 200;
constexpr int most_rings = 4, most_rounds = 5;

double distance_to(const SurfaceSoup& soup, std::span<const Triangle> triangles, const Vec3& p) {
  double least = std::numeric_limits<double>::max();
  for (const auto& [a, b, c] : triangles)
    if (!geometry::are_collinear(soup.points[a], soup.points[b], soup.points[c]))
      least = std::min(least, geometry::TriangleDistance(soup.points[a], soup.points[b], soup.points[c]).squared(p));
  return std::sqrt(least);
}

class FoldRemover {
 public:
  FoldRemover(SurfaceSoup& soup, const FoldRule& rule) : soup_(soup), rule_(rule) {}

  FoldReport remove() {
    for (int round = 0; round < most_rounds && remove_once(); ++round) {
    }
    return report_;
  }

 private:
  // Mends places that do not touch each other; returns whether there were any.
  bool remove_once() {
    for (const auto& [a, b, c] : soup_.triangles)
      if (geometry::are_collinear(soup_.points[a], soup_.points[b], soup_.points[c])) return false;
    const auto found = geometry::find_intersections(soup_.points, soup_.triangles, most_pairs);
    if (found.pairs.empty() || !found.complete) return false;
    find_twins();
    old_count_ = soup_.triangles.size();
    kept_.assign(old_count_, true);
    touched_.assign(old_count_, false);
    bool any = false;
    for (Patch& place : places_of(found.pairs)) any = mend(std::move(place)) || any;
    kept_.resize(soup_.triangles.size(), true);
    keep_only(soup_, kept_);
    return any;
  }

  void find_twins() {
    twins_.assign(3 * soup_.triangles.size(), no_index);
    geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const HalfEdge> edge) {
      if (edge.size() != 2) return;
      twins_[edge[0]] = edge[1];
      twins_[edge[1]] = edge[0];
    });
  }

  // The triangles of pairs that have one in common.
  std::vector<Patch> places_of(std::span<const std::array<std::int32_t, 2>> pairs) const {
    JoinedSets sets(old_count_);
    for (const auto& [t, u] : pairs) sets.join(t, u);
    std::map<std::int32_t, Patch> by_set;
    for (const auto& pair : pairs)
      for (const std::int32_t t : pair) by_set[sets.of(t)].insert(t);
    std::vector<Patch> places;
    for (auto& [set, place] : by_set) places.push_back(std::move(place));
    return places;
  }

  bool mend(Patch patch) {
    for (int ring = 0; ring <= most_rings; ++ring) {
      if (patch.size() > most_of_patch || 2 * patch.size() > old_count_) return false;
      if (std::ranges::any_of(patch, [&](std::int32_t t) { return touched_[t]; })) return false;
      if (replace(patch)) return true;
      const Patch inner = patch;
      for (const std::int32_t t : inner)
        for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h)
          if (twins_[h] != no_index) patch.insert(geometry::triangle_of(twins_[h]));
    }
    return false;
  }

  // Half-edges of the patch to triangles outside it, in order around it; nothing unless they are one simple loop.
  std::optional<std::vector<HalfEdge>> border_of(const Patch& patch) const {
    std::map<Vertex, HalfEdge> from;
    for (const std::int32_t t : patch)
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const HalfEdge twin = twins_[h];
        if (twin == no_index || geometry::start_of(soup_.triangles, h) != geometry::end_of(soup_.triangles, twin))
          return std::nullopt;
        if (patch.contains(geometry::triangle_of(twin))) continue;
        if (!from.try_emplace(geometry::start_of(soup_.triangles, h), h).second) return std::nullopt;
      }
    if (from.size() < 3) return std::nullopt;
    std::vector<HalfEdge> border;
    for (Vertex at = from.begin()->first; border.size() < from.size();
         at = geometry::end_of(soup_.triangles, border.back())) {
      const auto next = from.find(at);
      if (next == from.end() || (!border.empty() && next->second == border.front())) return std::nullopt;
      border.push_back(next->second);
    }
    return border;
  }

  bool replace(const Patch& patch) {
    const auto border = border_of(patch);
    if (!border || (rule_.keeps_shape && !(is_disk(patch) && has_one_tag(patch)))) return false;
    std::vector<HoleEdge> edges;
    for (const HalfEdge h : *border)
      edges.push_back({.start = geometry::start_of(soup_.triangles, h),
                       .across = geometry::start_of(soup_.triangles, geometry::previous_in_triangle(twins_[h]))});
    const std::vector<Triangle> triangles = fill_hole(soup_.points, edges);
    if (triangles.empty() || !is_near(patch, triangles) || intersects(patch, triangles)) return false;
    const std::int32_t first = *patch.begin();
    for (const std::int32_t t : patch) kept_[t] = false, touched_[t] = true;
    for (const HalfEdge h : *border) touched_[geometry::triangle_of(twins_[h])] = true;
    for (const Triangle& t : triangles) {
      soup_.triangles.push_back(t);
      soup_.tags.push_back(soup_.tags[first]);
      soup_.places.push_back(soup_.places[first]);
    }
    ++report_.places;
    report_.triangles += patch.size();
    return true;
  }

  // From the corners of the old triangles, and from points of the new ones.
  bool is_near(const Patch& patch, std::span<const Triangle> triangles) const {
    std::vector<Triangle> old;
    for (const std::int32_t t : patch) old.push_back(soup_.triangles[t]);
    for (const Triangle& t : old)
      for (const Vertex v : t)
        if (distance_to(soup_, triangles, soup_.points[v]) > rule_.tolerance) return false;
    const int parts = rule_.keeps_shape ? 8 : 2;
    for (const Triangle& t : triangles) {
      const Vec3 &a = soup_.points[t[0]], &b = soup_.points[t[1]], &c = soup_.points[t[2]];
      const auto is_far = [&](double u, double v) {
        return distance_to(soup_, old, a + u * (b - a) + v * (c - a)) > rule_.tolerance;
      };
      if (is_far(1.0 / 3, 1.0 / 3)) return false;
      for (int i = 0; i <= parts; ++i)
        for (int k = 0; i + k <= parts; ++k)
          if (is_far(static_cast<double>(i) / parts, static_cast<double>(k) / parts)) return false;
    }
    return true;
  }

  bool has_one_tag(const Patch& patch) const {
    return std::ranges::all_of(patch, [&](std::int32_t t) { return soup_.tags[t] == soup_.tags[*patch.begin()]; });
  }

  // By Euler's number: one more corner than edges less triangles.
  bool is_disk(const Patch& patch) const {
    std::set<Vertex> corners;
    std::size_t edges_twice = 0;
    for (const std::int32_t t : patch) {
      corners.insert(soup_.triangles[t].begin(), soup_.triangles[t].end());
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h)
        edges_twice += twins_[h] != no_index && patch.contains(geometry::triangle_of(twins_[h])) ? 1 : 2;
    }
    return corners.size() + patch.size() == edges_twice / 2 + 1;
  }

  // Whether new triangles have no area, or intersect each other or those that stay.
  bool intersects(const Patch& patch, std::span<const Triangle> triangles) const {
    std::vector<Triangle> all(triangles.begin(), triangles.end());
    std::vector<Vec3> corners;
    for (const auto& [a, b, c] : triangles) {
      if (geometry::are_collinear(soup_.points[a], soup_.points[b], soup_.points[c])) return true;
      corners.insert(corners.end(), {soup_.points[a], soup_.points[b], soup_.points[c]});
    }
    const Box around = Box::around(corners);
    for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
      if ((t < kept_.size() && !kept_[t]) || patch.contains(static_cast<std::int32_t>(t))) continue;
      const auto [a, b, c] = soup_.triangles[t];
      const Box box = Box::around(std::array{soup_.points[a], soup_.points[b], soup_.points[c]});
      bool meets = true;
      for (int axis = 0; axis < 3; ++axis)
        meets = meets && box.low[axis] <= around.high[axis] && around.low[axis] <= box.high[axis];
      if (meets) all.push_back(soup_.triangles[t]);
    }
    const auto found = geometry::find_intersections(soup_.points, all, most_pairs);
    return !found.complete || std::ranges::any_of(found.pairs, [&](const auto& pair) {
      return static_cast<std::size_t>(pair[0]) < triangles.size();
    });
  }

  SurfaceSoup& soup_;
  const FoldRule& rule_;
  FoldReport report_;
  std::size_t old_count_ = 0;         // of triangles, at the beginning of a round
  std::vector<HalfEdge> twins_;       // of edges with two triangles; otherwise no_index
  std::vector<bool> kept_, touched_;  // by triangle of the round's beginning
};

}  // namespace

FoldReport remove_folds(SurfaceSoup& soup, const FoldRule& rule) {
  return FoldRemover(soup, rule).remove();
}

}  // namespace hexpipe::tetmesh::solid
