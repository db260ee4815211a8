#include "tools/assemble/shape/input_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/defaults.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/joined_sets.hpp"
#include "tools/assemble/shape/nearest_points.hpp"
#include "tools/assemble/shape/smooth_edges.hpp"

namespace hexpipe::assemble::shape {
namespace {

// A curve may turn by as much as a smooth surface.
const double cos_feature_angle = cosine_of_degrees(default_feature_angle);
// A vertex slides a few edges far at most. A walk that has not ended by then is at something odd, and a point too far
// away is as safe as the nearest.
constexpr int longest_walk = 30;

}  // namespace

InputSurface::InputSurface(const TetMesh& mesh, const TetAdjacency& adjacency) : mesh_(mesh) {
  if (!mesh.points.empty()) diagonal_ = Box::around(mesh.points).diagonal();
  triangles_ = triangles_at_vertices(mesh.points.size(), mesh.triangles);
  find_features();
  places_.resize(mesh.points.size());
  for (std::size_t v = 0; v < places_.size(); ++v) places_[v] = place_of(static_cast<Vertex>(v));
  find_lengths(adjacency);
}

void InputSurface::find_features() {
  struct Sides {
    std::array<std::int32_t, 3> triangles{};  // the first three
    std::size_t count = 0;
  };
  KeyMap<2, Sides> edges;
  edges.reserve(2 * mesh_.triangles.size());
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      Sides& sides = edges[edge_key(mesh_.triangles[t][i], mesh_.triangles[t][(i + 1) % 3])];
      if (sides.count < sides.triangles.size()) sides.triangles[sides.count++] = static_cast<std::int32_t>(t);
    }
  JoinedSets patches(mesh_.triangles.size());
  const KeySet<2> ridges = ridges_of(mesh_);
  std::vector<VertexKey<2>> features;
  for (const auto& [edge, sides] : edges) {
    const auto away_of = [&](std::int32_t t) { return away_from_edge(mesh_.points, mesh_.triangles[t], edge); };
    const bool smooth = !ridges.contains(edge) &&
                        is_smooth_edge(std::span(sides.triangles).first(sides.count), mesh_.triangle_tags, away_of);
    if (smooth)
      patches.join(sides.triangles[0], sides.triangles[1]);
    else
      features.push_back(edge);
  }
  patch_.resize(mesh_.triangles.size());
  for (std::size_t t = 0; t < patch_.size(); ++t) patch_[t] = patches.of(static_cast<std::int32_t>(t));

  std::sort(features.begin(), features.end());
  feature_offsets_.assign(mesh_.points.size() + 1, 0);
  for (const auto& edge : features) ++feature_offsets_[edge[0] + 1], ++feature_offsets_[edge[1] + 1];
  std::partial_sum(feature_offsets_.begin(), feature_offsets_.end(), feature_offsets_.begin());
  feature_ends_.resize(2 * features.size());
  std::vector<std::int64_t> next_end(feature_offsets_.begin(), feature_offsets_.end() - 1);
  for (const auto& edge : features) {
    feature_ends_[next_end[edge[0]]++] = edge[1];
    feature_ends_[next_end[edge[1]]++] = edge[0];
  }
}

void InputSurface::find_lengths(const TetAdjacency& adjacency) {
  lengths_.resize(mesh_.points.size());
  for (std::size_t v = 0; v < lengths_.size(); ++v) lengths_[v] = edge_length(static_cast<Vertex>(v));
  std::vector<double> reach;
  reach.reserve(mesh_.triangles.size());
  for (const auto& [a, b, c] : mesh_.triangles) reach.push_back(std::max({lengths_[a], lengths_[b], lengths_[c]}));
  const auto thickness = thickness_behind(mesh_, adjacency, reach);
  for (std::size_t t = 0; t < thickness.size(); ++t)
    for (const Vertex v : mesh_.triangles[t]) lengths_[v] = std::min(lengths_[v], thickness[t]);
}

// Whether all triangles at v are joined to each other by edges at v.
bool InputSurface::is_one_fan(Vertex v) const {
  const auto all = triangles_at(v);
  std::vector<std::int32_t> reached{all[0]};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (std::int32_t other : all) {
      int shared = 0;
      for (Vertex a : mesh_.triangles[other])
        for (Vertex b : mesh_.triangles[reached[i]]) shared += a == b;
      if (shared == 2 && std::find(reached.begin(), reached.end(), other) == reached.end()) reached.push_back(other);
    }
  return reached.size() == all.size();
}

InputSurface::Place InputSurface::place_of(Vertex v) const {
  if (triangles_at(v).empty()) return Place::inside;
  const std::int64_t first = feature_offsets_[v], count = feature_offsets_[v + 1] - first;
  if (!is_one_fan(v)) return Place::corner;
  if (count == 0) return Place::face;
  if (count != 2) return Place::corner;
  const Vec3 o = mesh_.points[v];
  const Vec3 one = unit(mesh_.points[feature_ends_[first]] - o), two = unit(mesh_.points[feature_ends_[first + 1]] - o);
  return dot(one, two) < -cos_feature_angle ? Place::curve : Place::corner;
}

InputSurface::Nearest InputSurface::descend(Vertex v, const Vec3& to, bool within_patch, double enough) const {
  const std::int32_t start = triangles_at(v)[0];
  Nearest best{start, {}, std::numeric_limits<double>::infinity()};
  // Neighbours share most of their triangles, and none becomes nearer when it is looked at again.
  std::array<Vertex, 3 * longest_walk + 1> seen;
  std::size_t seen_count = 0;
  // Whether a triangle at `w` is nearer.
  auto look_at = [&](Vertex w) {
    bool nearer = false;
    const auto seen_end = seen.begin() + static_cast<std::ptrdiff_t>(seen_count);
    if (std::find(seen.begin(), seen_end, w) != seen_end) return nearer;
    seen[seen_count++] = w;
    for (std::int32_t t : triangles_at(w)) {
      if (within_patch && patch_[t] != patch_[start]) continue;
      const auto& [a, b, c] = mesh_.triangles[t];
      const std::array triangle{mesh_.points[a], mesh_.points[b], mesh_.points[c]};
      if (is_surely_farther(triangle, to, best.distance_squared)) continue;
      const Vec3 at = nearest_on_triangle(triangle, to);
      const double distance = norm_squared(at - to);
      if (distance >= best.distance_squared) continue;
      best = {t, at, distance};
      nearer = true;
    }
    return nearer;
  };
  look_at(v);
  bool nearer = true;
  const double near_enough = enough * enough;
  for (int step = 0; nearer && best.distance_squared > near_enough && step < longest_walk; ++step) {
    nearer = false;
    const Triangle around = mesh_.triangles[best.triangle];
    for (Vertex w : around) nearer = look_at(w) || nearer;
  }
  return best;
}

InputSurface::Foot InputSurface::foot_on_curve(Vertex v, const Vec3& to) const {
  Foot best{mesh_.points[v], {}};
  double least = std::numeric_limits<double>::infinity();
  for (int way = 0; way < 2; ++way) {
    Vertex from = v, next = feature_ends_[feature_offsets_[v] + way];
    for (int step = 0; step < longest_walk; ++step) {
      const Vec3 at = nearest_on_segment(mesh_.points[from], mesh_.points[next], to);
      const double distance = norm_squared(at - to);
      if (distance < least) {
        least = distance;
        best = {at, unit(mesh_.points[next] - mesh_.points[from])};
      }
      // Goes on to the next edge only if this one ends too soon.
      if (at != mesh_.points[next] || places_[next] != Place::curve) break;
      const auto ends = std::span(feature_ends_).subspan(feature_offsets_[next], 2);
      const Vertex beyond = ends[0] == from ? ends[1] : ends[0];
      from = std::exchange(next, beyond);
    }
  }
  return best;
}

InputSurface::Foot InputSurface::foot(Vertex v, const Vec3& to) const {
  if (places_[v] == Place::curve) return foot_on_curve(v, to);
  if (places_[v] != Place::face) return {mesh_.points[v], {}};
  const Nearest nearest = descend(v, to, true, 0);
  const auto& [a, b, c] = mesh_.triangles[nearest.triangle];
  const auto& p = mesh_.points;
  return {nearest.at, unit(cross(p[b] - p[a], p[c] - p[a]))};
}

double InputSurface::distance(Vertex v, const Vec3& to, double enough) const {
  if (triangles_at(v).empty()) return distance(to);  // peeled tets have left the boundary here
  return std::sqrt(descend(v, to, false, enough).distance_squared);
}

double InputSurface::distance(const Vec3& to) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh_.triangles) {
    const Vec3 at = nearest_on_triangle({mesh_.points[a], mesh_.points[b], mesh_.points[c]}, to);
    least = std::min(least, norm_squared(at - to));
  }
  return std::sqrt(least);
}

// The mean over the triangles at v.
double InputSurface::edge_length(Vertex v) const {
  double sum = 0;
  for (std::int32_t t : triangles_at(v))
    for (int i = 0; i < 3; ++i)
      sum += norm(mesh_.points[mesh_.triangles[t][i]] - mesh_.points[mesh_.triangles[t][(i + 1) % 3]]);
  return sum / static_cast<double>(std::max<std::size_t>(1, 3 * triangles_at(v).size()));
}

bool InputSurface::has_triangle(const Triangle& triangle) const {
  const auto key = key_of(triangle);
  return std::ranges::any_of(triangles_at(triangle[0]),
                             [&](std::int32_t t) { return key_of(mesh_.triangles[t]) == key; });
}

}  // namespace hexpipe::assemble::shape
