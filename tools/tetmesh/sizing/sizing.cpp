#include "tools/tetmesh/sizing/sizing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/defaults.hpp"
#include "common/run/error.hpp"

namespace hexpipe::tetmesh::sizing {
namespace {

constexpr double coarse_edge = 2.5, fine_edge = 0.4;
constexpr double tolerated_share = 0.25;
// In a piece of a triangle up to this long, in sizes, the size counts as that of its centre.
constexpr double longest_part = 2;

double area_of(const solid::Surface& surface, const Triangle& t) {
  const Vec3& origin = surface.points[t[0]];
  return norm(cross(surface.points[t[1]] - origin, surface.points[t[2]] - origin)) / 2;
}

double area_of(const solid::Surface& surface) {
  double area = 0;
  for (const Triangle& t : surface.triangles) area += area_of(surface, t);
  return area;
}

// The longest side of a triangle.
std::size_t longest_side(const std::array<Vec3, 3>& corners) {
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (norm_squared(corners[(i + 1) % 3] - corners[i]) > norm_squared(corners[(longest + 1) % 3] - corners[longest]))
      longest = i;
  return longest;
}

}  // namespace

Length parse_length(std::string_view text) {
  Length length;
  std::string_view digits = text;
  length.percent_of_diagonal = digits.ends_with('%');
  if (length.percent_of_diagonal) digits.remove_suffix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), length.value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(length.value) || length.value <= 0)
    throw UsageError(
        fmt::format("expected a positive length such as 2.5, or 3% of the bounding box's diagonal, found '{}'", text));
  return length;
}

double bounding_box_diagonal(const formats::SurfaceSoup& surface) {
  return Box::around(surface.points).diagonal();
}

double in_units(const Length& length, const formats::SurfaceSoup& surface) {
  return length.percent_of_diagonal ? length.value / 100 * bounding_box_diagonal(surface) : length.value;
}

double element_size(const solid::Surface& surface, const std::optional<Length>& length, bool triangles_stay) {
  if (length) return in_units(*length, surface);
  const double area = area_of(surface), volume = surface.volume();
  const double spacing = std::sqrt(area / static_cast<double>(surface.points.size()));
  return default_size({bounding_box_diagonal(surface), area, volume},
                      triangles_stay ? spacing : std::numeric_limits<double>::infinity());
}

double mean_wall_thickness(const solid::Surface& surface) {
  return 2 * surface.volume() / area_of(surface);
}

double points_on_surface(const solid::Surface& surface, const SizeField& size, double enough) {
  double sum = 0;
  std::vector<std::array<Vec3, 3>> parts;
  for (const auto& [a, b, c] : surface.triangles) {
    parts.assign(1, {surface.points[a], surface.points[b], surface.points[c]});
    while (!parts.empty() && sum <= enough) {
      const std::array<Vec3, 3> part = parts.back();
      parts.pop_back();
      const double here = size.at((part[0] + part[1] + part[2]) * (1.0 / 3));
      const std::size_t i = longest_side(part);
      const Vec3 &from = part[i], &to = part[(i + 1) % 3], &across = part[(i + 2) % 3];
      if (size.is_uniform() || norm(to - from) <= longest_part * here) {
        sum += norm(cross(to - from, across - from)) / 2 / here / here;
        continue;
      }
      const Vec3 middle = 0.5 * (from + to);
      parts.push_back({from, middle, across});
      parts.push_back({middle, to, across});
    }
  }
  return sum;
}

double points_expected(const solid::Surface& surface, double size) {
  return surface.volume() / size / size / size;
}

SizeFit fit_to_size(const solid::Surface& surface, const SizeField& size) {
  double area = 0, coarse = 0, fine = 0;
  std::vector<double> edges;
  edges.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    double shortest = std::numeric_limits<double>::max(), longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double edge = norm(surface.points[t[(i + 1) % 3]] - surface.points[t[i]]);
      shortest = std::min(shortest, edge);
      longest = std::max(longest, edge);
      edges.push_back(edge);
    }
    const double triangle_area = area_of(surface, t);
    const double here = size.at((surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) * (1.0 / 3));
    area += triangle_area;
    if (longest > coarse_edge * here)
      coarse += triangle_area;
    else if (shortest < fine_edge * here)
      fine += triangle_area;
  }
  const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::ranges::nth_element(edges, middle);
  return {*middle, coarse / area, fine / area};
}

std::optional<std::string> SizeFit::complaint(double size) const {
  if (coarse_share + fine_share <= tolerated_share) return std::nullopt;
  const bool mostly_coarse = coarse_share >= fine_share;
  return fmt::format(
      "{:.0f} % of the surface lies in triangles with edges {} the size {:.3g} (the median edge is {:.3g}); the "
      "surface is kept as it is, so few hexes will touch it there",
      100 * (mostly_coarse ? coarse_share : fine_share), mostly_coarse ? "much longer than" : "much shorter than", size,
      median_edge);
}

}  // namespace hexpipe::tetmesh::sizing
