#include "formats/surfaces/surface_soup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "common/run/error.hpp"

namespace hexpipe::formats {
namespace {

// The counterpart of largest_coordinate: volumes and squares of determinants of shorter extents vanish.
constexpr double least_extent = 1e-50;

void check_magnitude(const SurfaceSoup& soup) {
  double least = std::numeric_limits<double>::max(), greatest = std::numeric_limits<double>::lowest(), extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto along_axis = [&](const Vec3& p) { return p[axis]; };
    const auto [lowest, highest] = std::ranges::minmax_element(soup.points, {}, along_axis);
    const double low = along_axis(*lowest), high = along_axis(*highest);
    least = std::min(least, low);
    greatest = std::max(greatest, high);
    extent = std::max(extent, high - low);
  }
  if (std::max(-least, greatest) > largest_coordinate)
    throw DataError::at(soup.name, "expected coordinates up to {:g}, found {:g}; scale the surface", largest_coordinate,
                        -least > greatest ? least : greatest);
  if (extent < least_extent)
    throw DataError::at(soup.name, "expected a surface at least {:g} long, found one of {:g}; scale the surface",
                        least_extent, extent);
}

}  // namespace

std::string SurfaceSoup::place_of(std::size_t triangle) const {
  return text ? fmt::format("{}:{}", name, places[triangle]) : fmt::format("{}: triangle {}", name, places[triangle]);
}

void keep_curves_if(SurfaceSoup& soup, const std::function<bool(const CurveEdge&)>& keeps) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < soup.curves.size(); ++i) {
    if (!keeps(soup.curves[i])) continue;
    soup.curves[kept] = soup.curves[i];
    soup.curve_tags[kept++] = soup.curve_tags[i];
  }
  soup.curves.resize(kept);
  soup.curve_tags.resize(kept);
}

void renumber_curves(SurfaceSoup& soup, std::span<const Vertex> number) {
  for (CurveEdge& edge : soup.curves)
    for (Vertex& end : edge) end = number[end];
  keep_curves_if(
      soup, [](const CurveEdge& edge) { return edge[0] != edge[1] && edge[0] != no_index && edge[1] != no_index; });
}

void check_extent(const SurfaceSoup& soup) {
  if (soup.triangles.empty()) throw DataError::at(soup.name, "expected a surface, found no triangles");
  if (soup.triangles.size() > std::numeric_limits<std::int32_t>::max() / 3)
    throw DataError::at(soup.name, "expected fewer than 2^31 / 3 triangles, found {}", soup.triangles.size());
  check_magnitude(soup);
}

}  // namespace hexpipe::formats
