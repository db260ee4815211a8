#include "tools/wrap/sharp_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hexpipe::wrap {
namespace {

// The third plane is another one than the first two from about 45 degrees on.
constexpr double corner_cosine = 0.7;

// The point of three planes, or nothing where they are nearly parallel.
std::optional<Vec3> meeting_point(const std::array<Plane, 3>& planes) {
  const Vec3 &n0 = planes[0].normal, &n1 = planes[1].normal, &n2 = planes[2].normal;
  const double volume = det(n0, n1, n2);
  if (std::abs(volume) < 1e-3) return std::nullopt;
  const auto height = [&](int i) { return dot(planes[i].normal, planes[i].point); };
  return (1 / volume) * (height(0) * cross(n1, n2) + height(1) * cross(n2, n0) + height(2) * cross(n0, n1));
}

std::array<std::size_t, 2> most_different(const std::array<Plane, 3>& planes) {
  std::array<std::size_t, 2> pair{0, 1};
  double least = 2;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i + 1; j < 3; ++j)
      if (const double cosine = dot(planes[i].normal, planes[j].normal); cosine < least) least = cosine, pair = {i, j};
  return pair;
}

}  // namespace

SharpPointFinder::SharpPointFinder(const TriangleTree& input, double feature_angle)
    : input_(input), sharp_cosine_(std::cos(feature_angle * std::numbers::pi / 180)) {}

std::optional<Vec3> SharpPointFinder::find(const std::array<Vec3, 3>& corners,
                                           const std::array<Plane, 3>& planes) const {
  const auto [i, j] = most_different(planes);
  if (!is_sharp(planes[i], planes[j])) return std::nullopt;
  const Vec3 middle = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
  const double size = std::sqrt(std::max({norm_squared(corners[1] - corners[0]), norm_squared(corners[2] - corners[1]),
                                          norm_squared(corners[0] - corners[2])}));
  const std::array<Plane, 3> meeting{planes[i], planes[j], planes[3 - i - j]};
  const Vec3 along = unit(cross(meeting[0].normal, meeting[1].normal));
  return meet(middle, size, meeting, std::abs(dot(along, meeting[2].normal)) > corner_cosine);
}

std::vector<Vec3> SharpPointFinder::find_all(const Vec3& middle, double size, const std::vector<Plane>& planes) const {
  std::vector<Vec3> found;
  const auto add = [&](const std::array<Plane, 3>& meeting, bool corner) {
    const auto point = meet(middle, size, meeting, corner);
    if (!point) return;
    for (const Vec3& other : found)
      if (norm(other - *point) < 1e-3 * size) return;
    found.push_back(*point);
  };
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      if (!is_sharp(planes[i], planes[j])) continue;
      add({planes[i], planes[j], planes[j]}, false);
      for (std::size_t k = 0; k < planes.size(); ++k)
        if (k != i && k != j && (k > j || !is_sharp(planes[i], planes[k]) || !is_sharp(planes[j], planes[k])))
          add({planes[i], planes[j], planes[k]}, true);
    }
  return found;
}

// Without a corner the third of the planes is not used.
std::optional<Vec3> SharpPointFinder::meet(const Vec3& middle, double size, std::array<Plane, 3> meeting,
                                           bool corner) const {
  if (!corner) meeting[2] = {middle, unit(cross(meeting[0].normal, meeting[1].normal))};
  auto point = meeting_point(meeting);
  // Where faces are curved the planes of their triangles near the point say it better than those of the corners.
  for (int round = 0; round < 3 && point && norm(*point - middle) < 1.5 * size; ++round) {
    for (int k = 0; k < (corner ? 3 : 2); ++k) meeting[k] = input_.facing_plane(*point, meeting[k].normal, 0.1 * size);
    if (!corner) meeting[2].normal = unit(cross(meeting[0].normal, meeting[1].normal));
    point = meeting_point(meeting);
  }
  if (!point || !(norm(*point - middle) < 1.5 * size)) return std::nullopt;
  if (!is_sharp(meeting[0], meeting[1])) return std::nullopt;
  const Vec3 on_input = input_.nearest(*point).point;
  if (norm(on_input - *point) > 1e-3 * size) return std::nullopt;
  return on_input;
}

}  // namespace hexpipe::wrap
