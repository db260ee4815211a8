#include "formats/surfaces/surface_building.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hexpipe::formats {
namespace {

constexpr std::size_t most_corners = 10'000;
// Rounding may turn a corner on a straight side by this share of the polygon's area.
constexpr double least_turn = 1e-14;

Vec3 area_of(std::span<const Vec3> points, const Triangle& t) {
  return cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
}

struct PlanePoint {
  double x, y;
  bool operator==(const PlanePoint&) const = default;
};

// Positive if a, b, c turn to the left.
double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The polygon in the projection in which it turns to the left.
std::vector<PlanePoint> projected(std::span<const Vec3> points, std::span<const Vertex> corners, const Vec3& normal) {
  int axis = 0;
  for (const int other : {1, 2})
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  int first = (axis + 1) % 3, second = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(first, second);
  std::vector<PlanePoint> places;
  places.reserve(corners.size());
  for (const Vertex v : corners) places.push_back({points[v][first], points[v][second]});
  return places;
}

class EarCutter {
 public:
  explicit EarCutter(std::vector<PlanePoint> places) : places_(std::move(places)) {
    const auto count = static_cast<std::int32_t>(places_.size());
    for (std::int32_t i = 0; i < count; ++i) around_.push_back({(i + count - 1) % count, (i + 1) % count});
    for (std::int32_t i = 0; i < count; ++i)
      if (!is_convex(i)) others_.push_back(i);
    for (std::int32_t i = 0; i < count; ++i) is_ear_.push_back(has_no_other_inside(i));
  }

  // Places in the polygon, three for each triangle; fewer triangles than it takes where no ear is left.
  std::vector<std::array<std::int32_t, 3>> cut() {
    std::vector<std::array<std::int32_t, 3>> ears;
    std::size_t left = places_.size(), passed = 0;
    for (std::int32_t i = 0; left > 2 && passed < left;) {
      const auto [before, after] = around_[i];
      if (!is_ear_[i]) {
        ++passed;
        i = after;
        continue;
      }
      ears.push_back({before, i, after});
      around_[before].after = after;
      around_[after].before = before;
      --left;
      passed = 0;
      // Cutting off an ear makes corners beside it convex, never the other way round.
      std::erase_if(others_, [&](std::int32_t k) { return k == i || ((k == before || k == after) && is_convex(k)); });
      // Any other ear was an ear of the whole polygon.
      for (const std::int32_t k : {before, after}) is_ear_[k] = has_no_other_inside(k);
      // On to the next but one: going on beside it would cut a fan of needles.
      i = around_[after].after;
    }
    return ears;
  }

 private:
  struct Neighbours {
    std::int32_t before, after;
  };

  bool is_convex(std::int32_t i) const {
    return turn(places_[around_[i].before], places_[i], places_[around_[i].after]) > 0;
  }

  // Only a corner that is not convex can be inside the triangle of a convex one.
  bool has_no_other_inside(std::int32_t i) const {
    if (!is_convex(i)) return false;
    const PlanePoint &a = places_[around_[i].before], &b = places_[i], &c = places_[around_[i].after];
    return std::ranges::none_of(others_, [&](std::int32_t k) {
      const PlanePoint& p = places_[k];
      if (p == a || p == b || p == c) return false;
      return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  }

  std::vector<PlanePoint> places_;
  std::vector<Neighbours> around_;
  std::vector<char> is_ear_;
  std::vector<std::int32_t> others_;  // the corners that are left and not convex
};

}  // namespace

void cut_if_concave(std::span<const Vec3> points, std::span<Triangle> fan) {
  Vec3 normal;
  for (const Triangle& t : fan) normal += area_of(points, t);
  const double most = -least_turn * norm_squared(normal);
  const auto is_turned = [&](const Triangle& t) { return dot(area_of(points, t), normal) < most; };
  if (fan.size() + 2 > most_corners || std::ranges::none_of(fan, is_turned)) return;
  std::vector<Vertex> corners{fan[0][0], fan[0][1]};
  for (const Triangle& t : fan) corners.push_back(t[2]);
  const auto ears = EarCutter(projected(points, corners, normal)).cut();
  if (ears.size() < fan.size()) return;
  for (std::size_t i = 0; i < fan.size(); ++i) fan[i] = {corners[ears[i][0]], corners[ears[i][1]], corners[ears[i][2]]};
}

}  // namespace hexpipe::formats
