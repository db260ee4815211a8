// Points of a lattice that fits the field come first (surface_lattice.hpp). Where its parts do not fit together,
// packing of parallelograms fills what they leave: each point, first come first served, offers its four neighbours in
// the directions of the field; one is taken when no point is nearer than a part of the size in the maximum norm of the
// field's directions there (Baudouin, Remacle, Marchandise, Henrotte, Geuzaine 2014, section 3). Where a direction
// meets a feature curve within a few sizes, the steps are stretched so that a whole number fits, which their paper
// leaves to chance.

#include "tools/tetmesh/surface/surface_front.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/tetmesh/surface/surface_lattice.hpp"
#include "tools/tetmesh/surface/surface_point_grid.hpp"

namespace hexpipe {
namespace {

// Points nearer than this, in sizes, are refused.
constexpr double least_distance = 0.7;
// Normals of points that may be in each other's way have at least this cosine: those of the two sides of a wall do not.
constexpr double least_normal_cosine = 0.3;
// How far, in sizes, a front looks ahead for the feature curve to fit its steps to, and with how much of that still
// ahead it goes on without looking again.
constexpr double look_ahead = 30, least_ahead = 15;
// Cosine from which a direction is the one in which a point was reached.
constexpr double same_way = 0.999;

// What is known of the way ahead.
struct Outlook {
  Vec3 heading;
  double step = 0;   // to walk
  double steps = 0;  // until a feature is met; 0: none is in sight
  double clear = 0;  // how far none is, then

  bool holds_for(const Vec3& direction, double least) const {
    return (steps > 0 || clear > least) && dot(heading, direction) > same_way;
  }
  Outlook after_step(const Vec3& new_heading) const {
    return {new_heading, step, std::max(0.0, steps - 1), clear - step};
  }
};

class SurfaceFront {
 public:
  SurfaceFront(const FieldSurface& surface, const CrossField& field, double size)
      : surface_(surface), field_(field), walker_(surface, field), size_(size), grid_(size) {}

  std::vector<SurfacePoint> run(std::span<const Vertex> kept) {
    add_kept(kept);
    for (const SurfacePoint& p : surface_lattice(surface_, field_, kept, size_))
      if (is_free(p, least_distance)) take(p, {});
    start_from_kept(kept);
    spread();
    fill_gaps();
    return std::move(points_);
  }

 private:
  void add_kept(std::span<const Vertex> kept);
  void start_from_kept(std::span<const Vertex> kept);
  void start_from_corner(HalfEdge h);
  void spread();
  void fill_gaps();
  void offer_step(const SurfacePoint& from, const Vec3& direction, const Outlook& known);
  Outlook look(const SurfacePoint& from, const Vec3& direction) const;
  // Whether no point is nearer than `distance` sizes.
  bool is_free(const SurfacePoint& point, double distance) const;
  void take(const SurfacePoint& point, const Outlook& outlook);

  const FieldSurface& surface_;
  const CrossField& field_;
  FieldWalker walker_;
  double size_;
  std::vector<SurfacePoint> points_;
  std::vector<Outlook> outlooks_;           // of the points, along the way on which they were reached
  std::size_t next_ = 0;                    // of the points, the first that has not yet offered its neighbours
  SurfacePointGrid grid_;                   // the kept vertices, then the points
  std::vector<std::vector<Vec3>> normals_;  // of the points in the grid, of each face around them that differs
};

void SurfaceFront::add_kept(std::span<const Vertex> kept) {
  std::vector<std::int32_t> number(surface_.points.size(), -1);
  for (const Vertex v : kept) {
    number[v] = grid_.add(surface_.points[v]);
    normals_.emplace_back();
  }
  for (std::size_t f = 0; f < surface_.triangles.size(); ++f)
    for (const Vertex v : surface_.triangles[f]) {
      if (number[v] < 0) continue;
      std::vector<Vec3>& normals = normals_[number[v]];
      const Vec3& n = surface_.normals[f];
      if (std::ranges::none_of(normals, [&](const Vec3& m) { return dot(n, m) > 0.99; })) normals.push_back(n);
    }
}

void SurfaceFront::start_from_kept(std::span<const Vertex> kept) {
  std::vector<bool> is_kept(surface_.points.size());
  for (const Vertex v : kept) is_kept[v] = true;
  const auto half_edge_count = static_cast<HalfEdge>(surface_.twins.size());
  for (HalfEdge h = 0; h < half_edge_count; ++h)
    if (is_kept[start_of(surface_.triangles, h)]) start_from_corner(h);
}

// The field's directions that lead from the start of h into its triangle.
void SurfaceFront::start_from_corner(HalfEdge h) {
  const std::int32_t f = triangle_of(h);
  const Vec3 left = surface_.inward(h), right = surface_.inward(previous_in_triangle(h));
  const SurfacePoint corner{surface_.points[start_of(surface_.triangles, h)], f};
  const Vec3 x = field_.directions[f], y = cross(surface_.normals[f], x);
  for (const Vec3& direction : {x, y, -x, -y})
    if (dot(direction, left) >= 0 && dot(direction, right) > 0) offer_step(corner, direction, {});
}

void SurfaceFront::spread() {
  for (; next_ < points_.size(); ++next_) {
    const SurfacePoint from = points_[next_];
    const Outlook outlook = outlooks_[next_];
    const Vec3 x = field_.directions[from.triangle], y = cross(surface_.normals[from.triangle], x);
    for (const Vec3& direction : {x, y, -x, -y}) offer_step(from, direction, outlook);
  }
}

void SurfaceFront::fill_gaps() {
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface_.triangles.size()); ++f) {
    const auto [a, b, c] = surface_.triangles[f];
    const SurfacePoint centre{(surface_.points[a] + surface_.points[b] + surface_.points[c]) * (1.0 / 3), f};
    if (!is_free(centre, least_distance)) continue;
    take(centre, {});
    spread();
  }
}

void SurfaceFront::offer_step(const SurfacePoint& from, const Vec3& direction, const Outlook& known) {
  WalkEnd end = walker_.walk(from, direction, size_);
  // Fitting moves the end of a step that is taken by at most a quarter of the size.
  if (!end.at_feature && !is_free(end.point, least_distance - 0.25)) return;
  const Outlook outlook = known.holds_for(direction, least_ahead * size_) ? known : look(from, direction);
  if (outlook.steps > 0) {
    if (outlook.steps < 2) return;
    end = walker_.walk(from, direction, outlook.step);
  }
  if (!end.at_feature && is_free(end.point, least_distance)) take(end.point, outlook.after_step(end.heading));
}

Outlook SurfaceFront::look(const SurfacePoint& from, const Vec3& direction) const {
  const WalkEnd far = walker_.walk(from, direction, look_ahead * size_);
  if (!far.at_feature) return {direction, size_, 0, far.length};
  const double steps = std::max(1.0, std::round(far.length / size_));
  return {direction, far.length / steps, steps, 0};
}

bool SurfaceFront::is_free(const SurfacePoint& point, double distance) const {
  const Vec3 &x = field_.directions[point.triangle], &n = surface_.normals[point.triangle];
  const Vec3 y = cross(n, x);
  const double least = distance * size_;
  return grid_.none_near(point.position, [&](std::int32_t i, const Vec3& other) {
    const Vec3 d = other - point.position;
    if (std::abs(dot(d, x)) >= least || std::abs(dot(d, y)) >= least || std::abs(dot(d, n)) >= least) return false;
    return std::ranges::any_of(normals_[i], [&](const Vec3& m) { return dot(n, m) > least_normal_cosine; });
  });
}

void SurfaceFront::take(const SurfacePoint& point, const Outlook& outlook) {
  grid_.add(point.position);
  outlooks_.push_back(outlook);
  normals_.push_back({surface_.normals[point.triangle]});
  points_.push_back(point);
}

}  // namespace

std::vector<SurfacePoint> surface_front(const FieldSurface& surface, const CrossField& field,
                                        std::span<const Vertex> kept, double size) {
  return SurfaceFront(surface, field, size).run(kept);
}

}  // namespace hexpipe
