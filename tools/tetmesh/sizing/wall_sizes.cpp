#include "tools/tetmesh/sizing/wall_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/sizing/exit_grid.hpp"

namespace hexpipe::tetmesh::sizing {
namespace {

constexpr double least_cosine = 0.70710678118654752;  // the cosine of 45 degrees
constexpr double least_wedge = 0.26794919243112270;   // the tangent of 15 degrees
constexpr double least_part = 1.0 / 32;               // of the size
// Rays start this far from their triangle, in sizes, and ignore anything nearer.
constexpr double least_length = 1e-6;
// At most this many pieces of a triangle send rays; beyond it, rays are more than a size apart.
constexpr std::size_t most_parts = 1u << 20;
constexpr std::int64_t triangles_at_once = 256;
// With this many triangles for each square of the size, rays are many, and most of them are told apart by a grid.
constexpr double dense = 8;

using Corners = std::array<Vec3, 3>;
using Walls = std::vector<SizePrism>;

class WallFinder {
 public:
  WallFinder(const solid::Surface& surface, double size, int layers)
      : surface_(surface),
        size_(size),
        layers_(layers),
        tree_(geometry::tree_of_triangles(surface.points, surface.triangles)) {
    const bool has_interfaces =
        std::ranges::any_of(surface.shells, [](const solid::Shell& s) { return s.in_front != solid::outside_region; });
    if (!has_interfaces && is_dense()) exits_.emplace(surface.points, surface.triangles, layers * size);
  }

  Walls find() const {
    return parallel_collect<SizePrism>(
        static_cast<std::int64_t>(surface_.triangles.size()), triangles_at_once,
        [&](std::int64_t t, Walls& found) { look_from(static_cast<std::size_t>(t), found); });
  }

 private:
  bool is_dense() const;
  void look_from(std::size_t triangle, Walls& walls) const;
  void look(const Corners& corners, const Vec3& inwards, Walls& walls) const;
  double thickness_at(const Vec3& from, const Vec3& inwards) const;
  bool is_wedge(const Vec3& from, const Vec3& inwards, double thickness, const Vec3& outwards) const;
  double first_hit(const Vec3& from, const Vec3& direction, double longest) const;
  double length_to(std::int32_t triangle, const Vec3& from, const Vec3& direction) const;

  const solid::Surface& surface_;
  double size_;
  int layers_;
  geometry::BoxTree tree_;
  std::optional<ExitGrid> exits_;
};

bool WallFinder::is_dense() const {
  double twice_area = 0;
  for (const auto& [a, b, c] : surface_.triangles)
    twice_area += norm(cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]));
  return static_cast<double>(surface_.triangles.size()) * size_ * size_ > dense * twice_area / 2;
}

void WallFinder::look_from(std::size_t triangle, Walls& walls) const {
  const auto& [a, b, c] = surface_.triangles[triangle];
  const Corners corners{surface_.points[a], surface_.points[b], surface_.points[c]};
  const solid::Shell& shell = surface_.shells[surface_.shell_of[triangle]];
  const Vec3 normal = unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
  if (norm_squared(normal) == 0) return;
  look(corners, -normal, walls);
  if (shell.in_front != solid::outside_region) look(corners, normal, walls);
}

// Works in pieces of a size.
void WallFinder::look(const Corners& corners, const Vec3& inwards, Walls& walls) const {
  std::vector<Corners> parts{corners};
  for (std::size_t looked = 0; !parts.empty(); ++looked) {
    const Corners part = parts.back();
    parts.pop_back();
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (norm_squared(part[(i + 1) % 3] - part[i]) > norm_squared(part[(longest + 1) % 3] - part[longest]))
        longest = i;
    const Vec3 &from = part[longest], &to = part[(longest + 1) % 3], &beside = part[(longest + 2) % 3];
    if (norm(to - from) > size_ && looked < most_parts) {
      parts.push_back({from, 0.5 * (from + to), beside});
      parts.push_back({0.5 * (from + to), to, beside});
      continue;
    }
    if (norm_squared(cross(part[1] - part[0], part[2] - part[0])) == 0) continue;
    const Vec3 centre = (part[0] + part[1] + part[2]) * (1.0 / 3);
    if (exits_ && !exits_->may_leave(centre, inwards)) continue;
    const double thickness = thickness_at(centre, inwards);
    if (thickness < layers_ * size_)
      walls.push_back({part, thickness * inwards, std::max(thickness / layers_, least_part * size_)});
  }
}

// Infinite where there is no wall.
double WallFinder::thickness_at(const Vec3& from, const Vec3& inwards) const {
  constexpr double no_wall = std::numeric_limits<double>::infinity();
  std::int32_t hit = no_index;
  double best = layers_ * size_;
  const double thickness = tree_.first_hit(from, inwards, best, [&](std::int32_t triangle) {
    const double length = length_to(triangle, from, inwards);
    if (length < best) best = length, hit = triangle;
    return length;
  });
  if (hit == no_index) return no_wall;
  const auto& [a, b, c] = surface_.triangles[hit];
  const Vec3 area = cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]);
  const Vec3 there = unit(area);
  if (std::abs(dot(there, inwards)) < least_cosine) return no_wall;
  return is_wedge(from, inwards, thickness, dot(there, inwards) < 0 ? -there : there) ? no_wall : thickness;
}

// Whether the two sides meet at an edge, instead of just coming nearer to each other. They meet if they are near enough
// at nine tenths of the way to the line in which their planes meet. `outwards` is the other side's normal.
bool WallFinder::is_wedge(const Vec3& from, const Vec3& inwards, double thickness, const Vec3& outwards) const {
  constexpr double way = 0.9, left = 1 - way, most_left = 1.5 * left;
  const double cosine = dot(outwards, inwards);
  const Vec3 to_edge = outwards - cosine * inwards;  // its length is the sine of the angle between the planes
  const double sine = norm(to_edge);
  if (sine < least_wedge * cosine) return false;
  const Vec3 inside = from + (way * thickness * cosine / (sine * sine)) * to_edge + (left / 2 * thickness) * inwards;
  const double most = most_left * thickness;
  return first_hit(inside, inwards, most) < most && first_hit(inside, -inwards, most) < most;
}

// Infinite where the ray hits nothing within `longest`.
double WallFinder::first_hit(const Vec3& from, const Vec3& direction, double longest) const {
  return tree_.first_hit(from, direction, longest,
                         [&](std::int32_t triangle) { return length_to(triangle, from, direction); });
}

// The direction has length 1. Infinite where the ray misses the triangle.
double WallFinder::length_to(std::int32_t triangle, const Vec3& from, const Vec3& direction) const {
  const auto& [a, b, c] = surface_.triangles[triangle];
  const double length =
      geometry::length_to_triangle(from, direction, surface_.points[a], surface_.points[b], surface_.points[c]);
  return length > least_length * size_ ? length : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<SizePrism> wall_sizes(const solid::Surface& surface, double size, int layers) {
  return WallFinder(surface, size, layers).find();
}

}  // namespace hexpipe::tetmesh::sizing
