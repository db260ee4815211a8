#include "tools/tetmesh/surface/bend_stretch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// A bend is how far the surface turns within this many sizes on both sides, up to features; bends that turn back on the
// other side do not count, and nothing is known where both ways together are shorter than the second number.
constexpr double bend_reach = 0.5, least_way = 0.2;
// Surfaces that turn by less, in radians, are flat.
constexpr double least_turn_of_bend = 0.0175;
// Rows lie at most this many times as close as the size, as steps along curves (curve_rows.cpp) do.
constexpr double most_stretch = 1.5;
// The stretch of a triangle is the least within this many sizes along the bend, looked for at these steps. With half or
// twice of that, there are as many hexes; without it, rows end where bends taper.
constexpr double even_reach = 4, even_step = 0.25;
// Where rows along the bend would have to be so many times as close as well, the surface bends both ways, as organic
// models do, and rows stay as they are.
constexpr double both_ways = 1.3;
constexpr double unknown = 0;

class BendFinder {
 public:
  BendFinder(const FieldSurface& surface, const CrossField& field, BendStretch& stretch)
      : surface_(surface),
        field_(field),
        walker_(surface, field),
        stretch_(stretch),
        asked_(surface.triangles.size(), {unknown, unknown}) {}

  void add() {
    for_each_free([&](std::int32_t f) { asked_[f] = {asked_across(f, 0), asked_across(f, 1)}; });
    for_each_free([&](std::int32_t f) {
      for (std::size_t across = 0; across < 2; ++across) {
        const double least = least_along(f, across);
        if (!(least > stretch_.factor[f])) continue;
        stretch_.factor[f] = least;
        stretch_.along[f] = field_.axes(surface_, f)[1 - across];
      }
    });
  }

 private:
  // Not for the triangles of small fillets. A body may read and change the stretch of its own triangle alone.
  template <class Body>
  void for_each_free(Body&& body) const {
    parallel_for(static_cast<std::int64_t>(asked_.size()), 512, [&](std::int64_t i) {
      const auto f = static_cast<std::int32_t>(i);
      if (stretch_.factor[f] == 1) body(f);
    });
  }

  // The stretch with which chords from row to row keep to the surface: a chord of length c leaves an arc of curvature k
  // by k c^2 / 8.
  double asked_across(std::int32_t f, std::size_t axis) const {
    const Vec3 direction = field_.axes(surface_, f)[axis];
    const double size = surface_.sizes[f], chord_height = surface_.chord_heights[f];
    double length = 0;
    const double turn = std::abs(turn_on(f, direction, length) + turn_on(f, -direction, length));
    if (!(length > least_way * size)) return unknown;
    if (!(turn > least_turn_of_bend)) return 1;
    return std::clamp(size * std::sqrt(turn / length / (8 * chord_height)), 1.0, most_stretch);
  }

  // By how much a straight way bends with the surface, in radians, more than 0 where the surface falls off. Adds the
  // length of the way.
  double turn_on(std::int32_t f, const Vec3& way, double& length) const {
    double turn = 0, left = bend_reach * surface_.sizes[f];
    const auto add_turn = [&](const SurfacePoint& at, const Vec3& direction, const TriangleExit& exit) {
      length += std::min(exit.length, left);
      left -= exit.length;
      if (left <= 0 || surface_.feature[exit.edge]) return false;
      const Vec3& beyond = surface_.normals[geometry::triangle_of(surface_.twins[exit.edge])];
      turn += std::atan2(dot(beyond, direction), dot(beyond, surface_.normals[at.triangle]));
      return true;
    };
    walk_straight_over(surface_, {surface_.centres[f], f}, way, add_turn);
    return turn;
  }

  // The least stretch that is asked for on the way along a bend; 1 if the surface bends along that way, too.
  double least_along(std::int32_t f, std::size_t across) const {
    double least = asked_[f][across];
    if (asked_[f][1 - across] > both_ways) return 1;
    const double step = even_step * surface_.sizes[f], reach = even_reach * surface_.sizes[f];
    for (const double sign : {1.0, -1.0}) {
      WalkEnd end{{surface_.centres[f], f}, sign * field_.axes(surface_, f)[1 - across]};
      for (double gone = 0; gone < reach && least > 1 && !end.at_feature; gone += step) {
        end = walker_.walk(end.point, end.heading, step);
        const auto axes = field_.axes(surface_, end.point.triangle);
        const std::size_t along = std::abs(dot(axes[0], end.heading)) > std::abs(dot(axes[1], end.heading)) ? 0 : 1;
        const std::array<double, 2>& asked = asked_[end.point.triangle];
        if (asked[along] > both_ways) return 1;
        if (asked[1 - along] != unknown) least = std::min(least, asked[1 - along]);
      }
    }
    return least;
  }

  const FieldSurface& surface_;
  const CrossField& field_;
  const FieldWalker walker_;
  BendStretch& stretch_;
  std::vector<std::array<double, 2>>
      asked_;  // for ways along the two axes of each triangle; `unknown` on small fillets, too
};

}  // namespace

BendStretch bend_stretch(const FieldSurface& surface, const CrossField& field) {
  BendStretch stretch(surface.triangles.size());
  add_small_fillets(surface, stretch);
  if (!surface.chord_heights.empty()) BendFinder(surface, field, stretch).add();
  return stretch;
}

}  // namespace hexpipe::tetmesh::surface
