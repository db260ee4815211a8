#include "tools/assemble/gap/objective.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/mesh/face_measures.hpp"
#include "common/mesh/quality.hpp"

namespace hexpipe::assemble::gap {
namespace {

// Cells that are better cost no less. What a cell may cost for its quality opens the way to fewer cells, because flips
// that only make cells better let vertices merge afterwards: on mambo-s1 at 2.3, with 21,134 hexes, 1,735 tets are left
// where quality costs nothing, 1,148 with 0.3 here, 1,051 with 0.5, and as many with 0.7.
constexpr double good_quality = 0.5;
// The cost of a cell without any quality above that of a good one. 2 and 3 leave as many cells as 1.
constexpr double price_of_poverty = 1;
// A face that solvers have to correct for costs half a cell; twice that, where the angle is wider by 20 degrees, or the
// weight nothing.
constexpr double price_of_severe_face = 0.5;
constexpr double price_of_low_weight = 0.5;
constexpr double price_of_low_determinant = 0.5;
constexpr double wider_by = 20 * std::numbers::pi / 180;

// One determinant and six lengths, because this takes most of the time.
double quality_of_tet(std::span<const Vec3> points, std::span<const Vertex> corners) {
  const Vec3 o = points[corners[0]], p = points[corners[1]], q = points[corners[2]], r = points[corners[3]];
  const double op = norm_squared(p - o), oq = norm_squared(q - o), ors = norm_squared(r - o);
  const double pq = norm_squared(q - p), pr = norm_squared(r - p), qr = norm_squared(r - q);
  const double longest = std::max({op * oq * ors, op * pq * pr, oq * pq * qr, ors * pr * qr});
  return longest > 0 ? det(p - o, q - o, r - o) * std::sqrt(2 / longest) : 0;
}

}  // namespace

double quality_of(CellKind kind, std::span<const Vec3> points, std::span<const Vertex> corners) {
  if (kind == CellKind::tet) return quality_of_tet(points, corners);
  const auto at = corner_points(points, corners);
  return least_corner_scaled_jacobian(kind, std::span<const Vec3>(at).first(corners.size()));
}

double cost_of(double quality) {
  const double missing = std::max(0.0, 1 - quality / good_quality);
  return 1 + price_of_poverty * missing * missing;
}

double cost_of_face(double orthogonality, double weight) {
  static const double severe_cosine = std::cos(severe_angle);
  double cost = 0;
  if (orthogonality < severe_cosine)
    cost += price_of_severe_face * (1 + (std::acos(std::max(orthogonality, -1.0)) - severe_angle) / wider_by);
  if (weight < low_weight) cost += price_of_low_weight * (2 - weight / low_weight);
  return cost;
}

double cost_of_refused_weight(double weight) {
  return weight < low_weight ? price_of_refusal * (2 - weight / low_weight) : 0;
}

double cost_of_refused_sight(double sight) {
  return sight > 0 ? 0 : price_of_refusal * (1 + std::min(1.0, -sight));
}

double cost_of_span(double determinant) {
  return determinant < low_determinant ? price_of_low_determinant * (2 - determinant / low_determinant) : 0;
}

double cost_of_refused_span(double determinant) {
  return determinant < low_determinant ? price_of_refusal * (2 - determinant / low_determinant) : 0;
}

}  // namespace hexpipe::assemble::gap
