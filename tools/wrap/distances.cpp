#include "tools/wrap/surface.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::wrap {

DistanceSummary distances(const Surface& surface, const TriangleTree& other, double spacing, double limit) {
  // Points of a very large triangle are farther apart.
  constexpr int most_parts = 100;
  DistanceSummary summary;
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    const double longest = std::max({norm(q - p), norm(r - q), norm(p - r)});
    const int parts = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, most_parts);
    const double share = norm(cross(q - p, r - p)) / 2 / ((parts + 1) * (parts + 2) / 2);
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const Vec3 at = p + (double(i) / parts) * (q - p) + (double(j) / parts) * (r - p);
        const double distance = other.distance(at);
        summary.greatest = std::max(summary.greatest, distance);
        summary.mean += share * distance;
        if (distance > limit) summary.share_beyond += share;
        area += share;
      }
  }
  if (area > 0) summary.mean /= area, summary.share_beyond /= area;
  return summary;
}

}  // namespace hexpipe::wrap
