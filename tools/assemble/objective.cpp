#include "tools/assemble/objective.hpp"

#include <algorithm>
#include <cmath>

#include "common/mesh/quality.hpp"

namespace hexpipe {
namespace {

// Cells that are better cost no less.
const double good_quality = getenv("GQ")?atof(getenv("GQ")):0.5;
// The cost of a cell without any quality, above that of a good one.
const double price_of_poverty = getenv("PP")?atof(getenv("PP")):1.0;

}  // namespace

double tet_quality(std::span<const Vec3> points, std::span<const Vertex> corners) {
  const Vec3 o = points[corners[0]], p = points[corners[1]], q = points[corners[2]], r = points[corners[3]];
  const Vec3 a = p - o, b = q - o, c = r - o;
  const double determinant = det(a, b, c);
  const double oa = norm_squared(a), ob = norm_squared(b), oc = norm_squared(c);
  const double pq = norm_squared(q - p), pr = norm_squared(r - p), qr = norm_squared(r - q);
  const double longest = std::max({oa * ob * oc, oa * pq * pr, ob * pq * qr, oc * pr * qr});
  return longest > 0 ? determinant * std::sqrt(2 / longest) : 0;
}

double pyramid_quality(std::span<const Vec3> points, std::span<const Vertex> corners) {
  const Vec3 apex = points[corners[4]];
  std::array<Vec3, 4> side, up;
  std::array<double, 4> side_squared, up_squared;
  for (std::size_t i = 0; i < 4; ++i) {
    side[i] = points[corners[(i + 1) % 4]] - points[corners[i]];
    up[i] = apex - points[corners[i]];
    side_squared[i] = norm_squared(side[i]);
    up_squared[i] = norm_squared(up[i]);
  }
  double least = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t last = (i + 3) % 4;
    const double lengths = side_squared[i] * side_squared[last] * up_squared[i];
    least = std::min(least, lengths > 0 ? det(side[last], side[i], up[i]) / std::sqrt(lengths) : 0);
  }
  return least;
}

double gap_quality(CellKind kind, std::span<const Vec3> points, std::span<const Vertex> corners) {
  if (kind == CellKind::tet) return tet_quality(points, corners);
  if (kind == CellKind::pyramid) return pyramid_quality(points, corners);
  const auto at = corner_points(points, corners);
  return least_corner_scaled_jacobian(kind, std::span<const Vec3>(at).first(corners.size()));
}

double cell_cost(double quality) {
  const double missing = std::max(0.0, 1 - quality / good_quality);
  return 1 + price_of_poverty * missing * missing;
}

}  // namespace hexpipe
