#include "tools/fitcad/nearest_simplex.hpp"

#include <algorithm>
#include <utility>

namespace hexpipe::fitcad {
namespace {

double share_along(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 along = to - from;
  const double square = norm_squared(along);
  return square > 0 ? std::clamp(dot(p - from, along) / square, 0.0, 1.0) : 0.0;
}

BoxTree tree_of(std::span<const Simplex> simplices) {
  std::vector<Box> boxes;
  boxes.reserve(simplices.size());
  for (const Simplex& simplex : simplices) boxes.push_back(Box::around(simplex));
  return {boxes, std::vector<double>(boxes.size(), 0.0)};
}

}  // namespace

Weights nearest_weights(const Simplex& simplex, const Vec3& to) {
  const Vec3 u = simplex[1] - simplex[0], v = simplex[2] - simplex[0], r = to - simplex[0];
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
  const double area = uu * vv - uv * uv;
  if (area > 1e-24 * uu * vv) {
    const double a = (vv * dot(u, r) - uv * dot(v, r)) / area, b = (uu * dot(v, r) - uv * dot(u, r)) / area;
    if (a >= 0 && b >= 0 && a + b <= 1) return {1 - a - b, a, b};
  }
  // On one of the sides.
  Weights best{1, 0, 0};
  double least = norm_squared(r);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double s = share_along(simplex[i], simplex[j], to);
    Weights weights{};
    weights[i] = 1 - s;
    weights[j] = s;
    const double square = norm_squared(to - point_of(simplex, weights));
    if (square < least) least = square, best = weights;
  }
  return best;
}

SimplexTree::SimplexTree(std::vector<Simplex> simplices)
    : simplices_(std::move(simplices)), tree_(tree_of(simplices_)) {}

double SimplexTree::distance_to(std::int32_t simplex, const Vec3& to) const {
  const Simplex& corners = simplices_[static_cast<std::size_t>(simplex)];
  return norm(to - point_of(corners, nearest_weights(corners, to)));
}

double SimplexTree::distance(const Vec3& to, double most) const {
  return tree_.least(to, 1, most, [&](std::int32_t simplex) { return distance_to(simplex, to); });
}

std::vector<std::int32_t> SimplexTree::within(const Vec3& to, double reach) const {
  std::vector<std::int32_t> found;
  // No value is below `reach`, so that the search looks at all that are near enough.
  const double most = reach * (1 + 1e-6) + 1e-300;
  tree_.least(to, 1, most, [&](std::int32_t simplex) {
    if (distance_to(simplex, to) <= reach) found.push_back(simplex);
    return most;
  });
  std::ranges::sort(found);
  return found;
}

}  // namespace hexpipe::fitcad
