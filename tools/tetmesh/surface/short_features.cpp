// Half-edge collapses, the shortest edge first, so that every vertex that stays is one of the given surface, on its own
// features. A vertex remembers how far the farthest of those that went into it was; by that the surface moves no
// further than the limit, whatever comes together step by step.

#include "tools/tetmesh/surface/short_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/facet_key.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/surface/delaunay_flips.hpp"
#include "tools/tetmesh/surface/feature_curves.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// Triangles turn by at most 60 degrees, unless they are thinner than this many times the limit: those lie between
// features that all become points, one after the other.
constexpr double least_turn_cosine = 0.5, thin = 2;
// Walls keep their shape if they are this many times as thick as a vertex of theirs moves. Triangles with the area of a
// square of this many times the limit are small.
constexpr double least_wall = 6, small_triangle = 4;
// Sides of a wall are turned by at most 45 degrees against each other.
constexpr double opposite_cosine = 0.70710678118654752;
// Where triangles would intersect, the vertices there stay in the next attempt.
constexpr int most_joining_attempts = 4;
// The way along a curve from one of its points to another, by the distance of both, up to which it is no strip.
constexpr double longest_detour = 3;
constexpr std::size_t most_crossings = 1000;

// The least height of a triangle; `area` is twice its own.
double height_of(const std::array<Vec3, 3>& c, double area) {
  return area / std::max({norm(c[1] - c[0]), norm(c[2] - c[1]), norm(c[0] - c[2])});
}

// How thick the material is behind triangles, where it is thin. Each is looked at once.
class WallThickness {
 public:
  // `most`: where it is thicker, it is not measured.
  WallThickness(const solid::Surface& surface, double most)
      : surface_(surface), most_(most), known_(surface.triangles.size(), -1) {}

  // `most` where it is thicker.
  double behind(std::int32_t triangle) {
    double& known = known_[triangle];
    if (known < 0) known = measure(triangle);
    return known;
  }

 private:
  double measure(std::int32_t triangle) {
    if (!tree_) tree_.emplace(geometry::tree_of_triangles(surface_.points, surface_.triangles));
    const auto& [a, b, c] = surface_.triangles[triangle];
    const Vec3 &p = surface_.points[a], &q = surface_.points[b], &r = surface_.points[c];
    const Vec3 normal = unit(cross(q - p, r - p)), sum = p + q + r;
    const bool is_interface = surface_.shells[surface_.shell_of[triangle]].in_front != solid::outside_region;
    double least = most_;
    for (const Vec3& from :
         {sum * (1.0 / 3), (sum + 3 * p) * (1.0 / 6), (sum + 3 * q) * (1.0 / 6), (sum + 3 * r) * (1.0 / 6)}) {
      least = look(triangle, from, -normal, least);
      if (is_interface) least = look(triangle, from, normal, least);
    }
    return least;
  }

  double look(std::int32_t start, const Vec3& from, const Vec3& direction, double most) const {
    return tree_->first_hit(from, direction, most, [&](std::int32_t hit) {
      constexpr double nothing = std::numeric_limits<double>::infinity();
      if (hit == start) return nothing;
      const auto& [a, b, c] = surface_.triangles[hit];
      const Vec3 &p = surface_.points[a], &q = surface_.points[b], &r = surface_.points[c];
      if (std::abs(dot(unit(cross(q - p, r - p)), direction)) < opposite_cosine) return nothing;
      const double length = geometry::length_to_triangle(from, direction, p, q, r);
      return length > 0 ? length : nothing;
    });
  }

  const solid::Surface& surface_;
  double most_;
  std::vector<double> known_;  // by triangle; negative where it was not measured yet
  std::optional<BoxTree> tree_;
};

class FeatureJoiner {
 public:
  FeatureJoiner(const solid::Surface& surface, double feature_angle, const sizing::SizeField& shortest,
                const std::vector<bool>& stays, WallThickness& thickness)
      : surface_(surface), mesh_(surface, feature_angle), shortest_(shortest), stays_(stays), thickness_(thickness) {
    curves_.curves = surface.curves;
    curves_.curve_tags = surface.curve_tags;
    into_.resize(mesh_.n_vertices());
    for (std::size_t v = 0; v < into_.size(); ++v) into_[v] = static_cast<Vertex>(v);
    moved_.resize(mesh_.n_vertices());
    count_triangles();
  }

  // The number of vertices that went, or joined a feature.
  std::size_t run() {
    const std::size_t count = collapse_short(), joined = join_curves();
    // What joins a feature may now be near others of its points.
    return joined == 0 ? count : count + joined + collapse_short();
  }

  solid::Surface take() const;
  // Of the given surface, those that went into corners of these triangles of the new one, or joined features there.
  std::vector<Vertex> gone_into(const solid::Surface& made, std::span<const std::array<std::int32_t, 2>> pairs) const;

 private:
  using Entry = std::pair<double, int>;  // the length of an edge and its number

  double length_of(EdgeH e) const {
    const HalfEdgeH h = mesh_.halfedge_handle(e, 0);
    return norm(mesh_.position(mesh_.to_vertex_handle(h)) - mesh_.position(mesh_.from_vertex_handle(h)));
  }

  void offer(EdgeH e) {
    if (is_short(e)) queue_.push({length_of(e), e.idx()});
  }

  // Between two places of features that are no neighbours on one curve, or on a curve that is short as a whole.
  bool is_short(EdgeH e) const {
    const HalfEdgeH h = mesh_.halfedge_handle(e, 0);
    const VertexH a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
    if (mesh_.is_boundary(e) || !mesh_.is_on_feature(a) || !mesh_.is_on_feature(b)) return false;
    if (mesh_.has_copies(a) || mesh_.has_copies(b) || !shortest_.is_at_least(length_of(e), mesh_.position(a)))
      return false;
    return mesh_.is_feature(e) ? on_short_curve_[e.idx()] : !are_on_one_curve(a, b, length_of(e));
  }

  std::size_t collapse_short();
  std::size_t join_curves();
  void find_short_curves();
  bool are_on_one_curve(VertexH a, VertexH b, double distance) const;
  HalfEdgeH continuation(HalfEdgeH h) const;
  std::vector<Vertex> points_now() const;
  std::vector<Vertex> new_numbers() const;
  void bend_curves();
  bool takes_last_of_name(EdgeH e) const;
  bool collapse(EdgeH e);
  bool can_go(HalfEdgeH h);
  bool spares_wall(FaceH f, double move);

  void count_triangles() {
    triangles_of_.clear();
    for (const FaceH f : mesh_.faces()) ++triangles_of_[surface_.tags[mesh_.source(f)]];
  }
  std::size_t features_at(VertexH v) const {
    std::size_t count = 0;
    for (const EdgeH e : mesh_.ve_range(v)) count += mesh_.is_feature(e);
    return count;
  }
  // The edge is none of a border.
  std::array<std::int32_t, 2> tags_beside(EdgeH e) const {
    const auto tag = [&](unsigned side) {
      return surface_.tags[mesh_.source(mesh_.face_handle(mesh_.halfedge_handle(e, side)))];
    };
    return {tag(0), tag(1)};
  }

  const solid::Surface& surface_;
  FeatureMesh mesh_;
  const sizing::SizeField& shortest_;
  const std::vector<bool>& stays_;
  WallThickness& thickness_;
  std::vector<bool> on_short_curve_;  // by edge
  std::vector<Vertex> into_;          // by vertex
  std::vector<FlippedCap> flipped_;
  formats::SurfaceSoup curves_;                       // nothing but curves, between points of the given surface
  std::vector<double> moved_;                         // by vertex: the distance of the farthest one that went into it
  std::map<std::int32_t, std::size_t> triangles_of_;  // by tag
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

// The number of collapses.
std::size_t FeatureJoiner::collapse_short() {
  find_short_curves();
  for (const EdgeH e : mesh_.edges()) offer(e);
  std::size_t count = 0;
  while (!queue_.empty()) {
    const auto [length, number] = queue_.top();
    queue_.pop();
    const EdgeH e(number);
    // Its ends may have changed since, or itself.
    if (mesh_.status(e).deleted() || length_of(e) != length || !is_short(e)) continue;
    if (collapse(e)) ++count;
  }
  return count;
}

// Features go by the vertices that lie beside them. Returns the number of these.
std::size_t FeatureJoiner::join_curves() {
  flipped_ = flip_caps(mesh_, surface_, shortest_, [&](HalfEdgeH h, double moved) {
    const VertexH corner = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
    const double before = std::max(moved_[mesh_.from_vertex_handle(h).idx()], moved_[mesh_.to_vertex_handle(h).idx()]);
    return !stays_[mesh_.place(corner)] && shortest_.is_at_least(before + moved, mesh_.position(corner)) &&
           spares_wall(mesh_.face_handle(mesh_.opposite_halfedge_handle(h)), before + moved);
  });
  std::size_t count = 0;
  for (const FlippedCap& cap : flipped_) {
    if (!cap.was_feature) continue;
    ++count;
    moved_[cap.by.idx()] = std::max(moved_[cap.by.idx()], cap.moved);
    if (features_at(cap.by) > 2) mesh_.keep(cap.by);
  }
  if (count > 0) bend_curves();
  count_triangles();
  return count;
}

// Marks the edges of feature curves between corners that are no longer than the limit at one of these.
void FeatureJoiner::find_short_curves() {
  on_short_curve_.assign(mesh_.n_edges(), false);
  for (const FeatureCurve& curve : feature_curves(mesh_)) {
    const VertexH start = curve.vertices.front(), end = curve.vertices.back();
    if (!mesh_.is_kept(start) || !mesh_.is_kept(end)) continue;
    std::vector<EdgeH> edges;
    double length = 0;
    for (std::size_t i = 1; i < curve.vertices.size(); ++i) {
      edges.push_back(mesh_.edge_handle(mesh_.find_halfedge(curve.vertices[i - 1], curve.vertices[i])));
      length += length_of(edges.back());
    }
    const auto allows = [&](VertexH v) { return shortest_.is_at_least(length, mesh_.position(v)); };
    if (!allows(start) && !allows(end)) continue;
    for (const EdgeH e : edges) on_short_curve_[e.idx()] = true;
  }
}

// Whether a feature curve leads from one vertex to the other on hardly a longer way, by no corner.
bool FeatureJoiner::are_on_one_curve(VertexH a, VertexH b, double distance) const {
  for (HalfEdgeH h : mesh_.voh_range(a)) {
    if (!mesh_.is_feature(mesh_.edge_handle(h))) continue;
    for (double length = 0; h.is_valid(); h = continuation(h)) {
      length += length_of(mesh_.edge_handle(h));
      if (length >= longest_detour * distance) break;
      if (mesh_.to_vertex_handle(h) == b) return true;
    }
  }
  return false;
}

// The next half-edge of a feature curve; none at a corner.
HalfEdgeH FeatureJoiner::continuation(HalfEdgeH h) const {
  const VertexH end = mesh_.to_vertex_handle(h);
  HalfEdgeH next;
  if (!mesh_.is_kept(end))
    for (const HalfEdgeH out : mesh_.voh_range(end))
      if (mesh_.is_feature(mesh_.edge_handle(out)) && mesh_.edge_handle(out) != mesh_.edge_handle(h)) next = out;
  return next;
}

// Whether no wall behind the triangle, unless that is a small one, loses much if a corner or an edge moves that far.
bool FeatureJoiner::spares_wall(FaceH f, double move) {
  const double small = small_triangle * shortest_.at(mesh_.position(mesh_.corners(f)[0]));
  return norm(mesh_.area_normal(f)) <= 2 * small * small || thickness_.behind(mesh_.source(f)) >= least_wall * move;
}

// Whether the start of a half-edge can go to its end.
bool FeatureJoiner::can_go(HalfEdgeH h) {
  const VertexH from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
  const double length = length_of(mesh_.edge_handle(h));
  const double move = moved_[from.idx()] + length;
  if (stays_[from.idx()] || !shortest_.is_at_least(move, mesh_.position(from))) return false;
  for (const FaceH f : mesh_.vf_range(from))
    if (!spares_wall(f, move)) return false;
  const Vec3 end = mesh_.position(to);
  for (const HalfEdgeH out : mesh_.voh_range(from)) {
    const FaceH f = mesh_.face_handle(out);
    const VertexH b = mesh_.to_vertex_handle(out), c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(out));
    if (b == to || c == to) continue;
    const Vec3 before = mesh_.area_normal(f), after = cross(mesh_.position(b) - end, mesh_.position(c) - end);
    if (!(norm(after) > 0)) return false;
    if (dot(before, after) > least_turn_cosine * norm(before) * norm(after)) continue;
    const double widest = thin * shortest_.at(end);
    if (height_of(mesh_.positions(f), norm(before)) > widest ||
        height_of({end, mesh_.position(b), mesh_.position(c)}, norm(after)) > widest)
      return false;
  }
  return true;
}

// Whether no triangle of a tag with a name is left without those beside the edge.
bool FeatureJoiner::takes_last_of_name(EdgeH e) const {
  const auto [left, right] = tags_beside(e);
  const auto takes_last = [&](std::int32_t tag, std::size_t count) {
    return triangles_of_.at(tag) == count && surface_.names.surfaces.contains(tag);
  };
  return left == right ? takes_last(left, 2) : takes_last(left, 1) || takes_last(right, 1);
}

bool FeatureJoiner::collapse(EdgeH e) {
  HalfEdgeH h = mesh_.halfedge_handle(e, 0);
  // Where more curves meet is what stays.
  const auto rank = [&](VertexH v) { return std::pair(features_at(v), moved_[v.idx()]); };
  if (rank(mesh_.from_vertex_handle(h)) > rank(mesh_.to_vertex_handle(h))) h = mesh_.opposite_halfedge_handle(h);
  if (!mesh_.is_collapse_ok(h) || takes_last_of_name(e)) return false;
  if (!can_go(h) && !can_go(h = mesh_.opposite_halfedge_handle(h))) return false;
  const VertexH from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
  for (const std::int32_t tag : tags_beside(e)) --triangles_of_[tag];
  moved_[to.idx()] = std::max(moved_[to.idx()], moved_[from.idx()] + length_of(e));
  mesh_.collapse_edge(h);
  into_[from.idx()] = to.idx();
  for (const EdgeH around : mesh_.ve_range(to)) offer(around);
  return true;
}

// By point of the given surface, the one that it is now.
std::vector<Vertex> FeatureJoiner::points_now() const {
  std::vector<Vertex> result;
  for (std::size_t point = 0; point < surface_.points.size(); ++point) {
    auto v = static_cast<Vertex>(point);
    while (into_[v] != v) v = into_[v];
    result.push_back(mesh_.place(VertexH(v)));
  }
  return result;
}

// By point of the given surface, the point of the new one that it is now.
std::vector<Vertex> FeatureJoiner::new_numbers() const {
  const std::vector<Vertex> by_place = mesh_.point_numbers();
  std::vector<Vertex> result = points_now();
  for (Vertex& v : result) v = by_place[v];
  return result;
}

std::vector<Vertex> FeatureJoiner::gone_into(const solid::Surface& made,
                                             std::span<const std::array<std::int32_t, 2>> pairs) const {
  std::vector<bool> is_meant(made.points.size());
  for (const auto& pair : pairs)
    for (const std::int32_t triangle : pair)
      for (const Vertex v : made.triangles[triangle]) is_meant[v] = true;
  std::vector<Vertex> result;
  const std::vector<Vertex> number = new_numbers();
  for (std::size_t point = 0; point < number.size(); ++point)
    if (is_meant[number[point]] && into_[point] != static_cast<Vertex>(point))
      result.push_back(static_cast<Vertex>(point));
  for (const FlippedCap& cap : flipped_)
    if (is_meant[number[mesh_.place(cap.by)]]) result.push_back(mesh_.place(cap.by));
  return result;
}

// Lets curves go by the vertices that joined them. An edge that two would have stays with the first.
void FeatureJoiner::bend_curves() {
  formats::renumber_curves(curves_, points_now());
  std::map<VertexKey<2>, std::int32_t> tag_of;
  for (std::size_t i = 0; i < curves_.curves.size(); ++i)
    tag_of.emplace(key_of(curves_.curves[i]), curves_.curve_tags[i]);
  for (const FlippedCap& cap : flipped_) {
    const Vertex start = mesh_.place(cap.start), end = mesh_.place(cap.end), by = mesh_.place(cap.by);
    const auto found = tag_of.find(edge_key(start, end));
    if (found == tag_of.end()) continue;
    const std::int32_t tag = found->second;
    tag_of.erase(found);
    tag_of.emplace(edge_key(start, by), tag);
    tag_of.emplace(edge_key(by, end), tag);
  }
  curves_.curves.clear();
  curves_.curve_tags.clear();
  for (const auto& [edge, tag] : tag_of) {
    curves_.curves.push_back(edge);
    curves_.curve_tags.push_back(tag);
  }
}

// The surface without the triangles and curves that became points.
solid::Surface FeatureJoiner::take() const {
  solid::Surface made = mesh_.to_surface(surface_);
  made.curves = curves_.curves;
  made.curve_tags = curves_.curve_tags;
  formats::renumber_curves(made, new_numbers());
  KeySet<2> seen;
  formats::keep_curves_if(made, [&](const formats::CurveEdge& edge) { return seen.insert(key_of(edge)).second; });
  return made;
}

}  // namespace

std::optional<JoinedFeatures> join_short_features(const solid::Surface& surface, double feature_angle,
                                                  const sizing::SizeField& shortest) {
  std::vector<bool> stays(surface.points.size());
  WallThickness thickness(surface, least_wall * shortest.greatest());
  for (int attempt = 0; attempt < most_joining_attempts; ++attempt) {
    FeatureJoiner joiner(surface, feature_angle, shortest, stays, thickness);
    const std::size_t count = joiner.run();
    if (count == 0) break;
    JoinedFeatures made{joiner.take(), count};
    const auto pairs = geometry::find_intersections(made.surface.points, made.surface.triangles, most_crossings).pairs;
    if (pairs.empty()) return made;
    const std::vector<Vertex> gone = joiner.gone_into(made.surface, pairs);
    if (gone.empty()) break;
    for (const Vertex v : gone) stays[v] = true;
  }
  return std::nullopt;
}

}  // namespace hexpipe::tetmesh::surface
