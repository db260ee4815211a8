// Points of a lattice that fits the field come first (surface_lattice.hpp). Where the patches of the lattice do not fit
// together, packing of parallelograms fills the gaps. Each point, first come first served, offers its four neighbours
// in the directions of the field. A neighbour is taken if no point is nearer than a share of the size in the maximum
// norm of the field's directions there (Baudouin, Remacle, Marchandise, Henrotte, Geuzaine 2014, section 3). If a
// direction meets a feature curve within a few sizes, the steps are stretched so that a whole number fits; their paper
// leaves that to chance.

#include "tools/tetmesh/surface/surface_front.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// Points nearer than this, in steps of the lattice, are refused.
constexpr double least_distance = 0.7;
// The same for points that are known already.
constexpr double least_distance_of_known = 0.4;
// The normals of points that may be in each other's way have at least this cosine. Those of the two sides of a wall do
// not.
constexpr double same_side_cosine = 0.3;
// A triangle of the field is about one size long and has no room for more points at that distance. In a triangle that
// is so thin that its plane is noise, walks leave the surface, and a front would go on for ever in it.
constexpr int most_in_triangle = 9;
// How far, in sizes, a front looks ahead for the feature curve to which it fits its steps. It looks again when less
// than the second length is still ahead.
constexpr double look_ahead = 30, least_ahead = 15;
// Directions with at least this cosine count as the one in which a point was reached.
constexpr double same_way = 0.999;
// The number of places on the way to a feature at which the size is asked for.
constexpr std::size_t size_samples = 32;

// The knowledge about the way ahead.
struct Outlook {
  Vec3 heading;
  double step = 0;   // the length to walk, in sizes
  double steps = 0;  // until a feature is met; 0: none is in sight
  double clear = 0;  // if none is in sight: for how far

  bool holds_for(const Vec3& direction, double least) const {
    return (steps > 0 || clear > least) && dot(heading, direction) > same_way;
  }
  Outlook after_step(const WalkEnd& end) const {
    return {end.heading, step, std::max(0.0, steps - 1), clear - end.length};
  }
};

struct SizedPoint : SurfacePoint {
  double size = 0;  // at that place
};

class SurfaceFront {
 public:
  SurfaceFront(const FieldSurface& surface, const CrossField& field, const sizing::SizeField& size)
      : surface_(surface),
        field_(field),
        walker_(surface, field),
        size_(size),
        grid_(surface.points.front()),
        taken_in_(surface.triangles.size()) {}

  std::vector<SurfacePoint> run(const SurfaceLattice& lattice, std::span<const Vertex> kept,
                                std::span<const Vec3> known) {
    add_kept(kept);
    spacing_ = lattice.spacing;
    take_known(known);
    for (const SurfacePoint& p : lattice.points) take_if_free(sized(p), {});
    start_from_kept(kept);
    spread();
    fill_gaps();
    return std::move(points_);
  }

 private:
  void add_kept(std::span<const Vertex> kept);
  void start_from_kept(std::span<const Vertex> kept);
  void start_from_corner(geometry::HalfEdge h);
  void take_known(std::span<const Vec3> points);
  void spread();
  void fill_gaps();
  SizedPoint sized(const SurfacePoint& point) const { return {point, size_.at(point.position)}; }
  void offer_step(const SizedPoint& from, const Vec3& direction, const Outlook& known);
  WalkEnd step(const SizedPoint& from, const Vec3& direction, double sizes) const;
  double sizes_along(const Vec3& from, const WalkEnd& end) const;
  Outlook look(const SizedPoint& from, const Vec3& direction) const;
  // Whether no point is nearer than `distance` steps of the lattice, on the surface or off it.
  bool is_free(const SizedPoint& point, double distance) const;
  void take_if_free(const SizedPoint& point, const Outlook& outlook, double distance = least_distance);

  const FieldSurface& surface_;
  const CrossField& field_;
  FieldWalker walker_;
  const sizing::SizeField& size_;
  std::vector<SurfacePoint> points_;
  std::vector<double> sizes_;                   // at the points
  std::vector<Outlook> outlooks_;               // by point, along the way on which it was reached
  std::vector<std::array<double, 2>> spacing_;  // of the lattice, by triangle
  std::size_t next_ = 0;                        // the first point that has not yet offered its neighbours
  geometry::SizedPointGrid grid_;               // the kept vertices, then the points
  std::vector<std::vector<Vec3>> normals_;      // by point of the grid: the normals of the faces around it that differ
  std::vector<std::int8_t> taken_in_;           // by triangle: the number of points
};

void SurfaceFront::add_kept(std::span<const Vertex> kept) {
  std::vector<std::int32_t> number(surface_.points.size(), no_index);
  for (const Vertex v : kept) {
    number[v] = grid_.add(surface_.points[v], size_.at(surface_.points[v]));
    normals_.emplace_back();
  }
  for (std::size_t f = 0; f < surface_.triangles.size(); ++f)
    for (const Vertex v : surface_.triangles[f]) {
      if (number[v] == no_index) continue;
      std::vector<Vec3>& normals = normals_[number[v]];
      const Vec3& n = surface_.normals[f];
      if (std::ranges::none_of(normals, [&](const Vec3& m) { return dot(n, m) > 0.99; })) normals.push_back(n);
    }
}

void SurfaceFront::start_from_kept(std::span<const Vertex> kept) {
  std::vector<bool> is_kept(surface_.points.size());
  for (const Vertex v : kept) is_kept[v] = true;
  const auto half_edge_count = static_cast<geometry::HalfEdge>(surface_.twins.size());
  for (geometry::HalfEdge h = 0; h < half_edge_count; ++h)
    if (is_kept[geometry::start_of(surface_.triangles, h)]) start_from_corner(h);
}

// Starts in the field's directions that lead from the start of h into its triangle.
void SurfaceFront::start_from_corner(geometry::HalfEdge h) {
  const std::int32_t f = geometry::triangle_of(h);
  const Vec3 left = surface_.inward(h), right = surface_.inward(geometry::previous_in_triangle(h));
  const SizedPoint corner = sized({surface_.points[geometry::start_of(surface_.triangles, h)], f});
  const auto [x, y] = field_.axes(surface_, f);
  for (const Vec3& direction : {x, y, -x, -y})
    if (dot(direction, left) >= 0 && dot(direction, right) > 0) offer_step(corner, direction, {});
}

// Each at the nearest place on the surface, unless a feature is in the way.
void SurfaceFront::take_known(std::span<const Vec3> points) {
  if (points.empty()) return;
  const DistanceIndex index(surface_.points, surface_.triangles);
  for (const Vec3& p : points) {
    std::int32_t f = no_index;
    index.distance(p, f);
    const Vec3 &centre = surface_.centres[f], &normal = surface_.normals[f];
    const Vec3 way = p - centre - dot(p - centre, normal) * normal;
    const double length = norm(way);
    SurfacePoint point{centre, f};
    if (length > 0) {
      const WalkEnd end = walker_.walk_straight(point, unit(way), length);
      if (end.at_feature) continue;
      point = end.point;
    }
    take_if_free(sized(point), {}, least_distance_of_known);
  }
}

void SurfaceFront::spread() {
  for (; next_ < points_.size(); ++next_) {
    const SizedPoint from{points_[next_], sizes_[next_]};
    const Outlook outlook = outlooks_[next_];
    const auto [x, y] = field_.axes(surface_, from.triangle);
    for (const Vec3& direction : {x, y, -x, -y}) offer_step(from, direction, outlook);
  }
}

void SurfaceFront::fill_gaps() {
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface_.triangles.size()); ++f) {
    take_if_free({{surface_.centres[f], f}, surface_.sizes[f]}, {});
    spread();
  }
}

void SurfaceFront::offer_step(const SizedPoint& from, const Vec3& direction, const Outlook& known) {
  WalkEnd end = step(from, direction, 1);
  // Fitting moves the end of a step by at most a quarter of the size.
  if (!end.at_feature && !is_free(sized(end.point), least_distance - 0.25)) return;
  const Outlook outlook = known.holds_for(direction, least_ahead * from.size) ? known : look(from, direction);
  if (outlook.steps > 0) {
    if (outlook.steps < 2) return;
    end = step(from, direction, outlook.step);
  }
  if (!end.at_feature) take_if_free(sized(end.point), outlook.after_step(end));
}

// The step is as long as the mean of the sizes at its ends, times `sizes`.
WalkEnd SurfaceFront::step(const SizedPoint& from, const Vec3& direction, double sizes) const {
  const double size = sizes * from.size;
  const double mean = (size + sizes * size_.at(from.position + size * direction)) / 2;
  return walker_.walk(from, direction, mean);
}

// The length of a way in sizes, which are measured along its chord.
double SurfaceFront::sizes_along(const Vec3& from, const WalkEnd& end) const {
  if (size_.is_uniform()) return end.length / size_.greatest();
  double sum = 0;
  for (std::size_t i = 0; i < size_samples; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) / size_samples;
    sum += 1 / size_.at(from + middle * (end.point.position - from));
  }
  return end.length * sum / size_samples;
}

Outlook SurfaceFront::look(const SizedPoint& from, const Vec3& direction) const {
  const WalkEnd far = walker_.walk(from, direction, look_ahead * from.size);
  if (!far.at_feature) return {direction, 1, 0, far.length};
  const double sizes = sizes_along(from.position, far), steps = std::max(1.0, std::round(sizes));
  return {direction, sizes / steps, steps, 0};
}

bool SurfaceFront::is_free(const SizedPoint& point, double distance) const {
  const auto [x, y] = field_.axes(surface_, point.triangle);
  const Vec3& n = surface_.normals[point.triangle];
  const auto [along, across] = spacing_[point.triangle];
  const double least = distance * point.size;
  const double reach = std::max({1.0, distance * std::hypot(1.0, along, across)}) * point.size;
  const double least_size = size_.least_near(point.size, reach);
  return grid_.all_near(point.position, Vec3{reach, reach, reach}, least_size, [&](std::int32_t i) {
    const Vec3 d = grid_.points()[i] - point.position;
    const auto is_far = [&, off = dot(d, n)](const Vec3& axis, double wanted) {
      const double here = dot(d, axis);
      return here * here + off * off >= wanted * wanted;
    };
    if (is_far(x, along * least) || is_far(y, across * least)) return true;
    return std::ranges::none_of(normals_[i], [&](const Vec3& m) { return dot(n, m) > same_side_cosine; });
  });
}

void SurfaceFront::take_if_free(const SizedPoint& point, const Outlook& outlook, double distance) {
  if (taken_in_[point.triangle] == most_in_triangle || !is_free(point, distance)) return;
  ++taken_in_[point.triangle];
  grid_.add(point.position, point.size);
  outlooks_.push_back(outlook);
  normals_.push_back({surface_.normals[point.triangle]});
  points_.push_back(point);
  sizes_.push_back(point.size);
}

}  // namespace

FrontPoints surface_front(const CorrectedLinks& links, std::span<const Vertex> kept, const sizing::SizeField& size,
                          const RowOptions& rows, const RowGuide& guide) {
  const SurfaceLattice lattice = surface_lattice(links, kept, rows, guide);
  return {SurfaceFront(links.links.surface, links.links.field, size).run(lattice, kept, guide.points),
          lattice.row_ends};
}

}  // namespace hexpipe::tetmesh::surface
