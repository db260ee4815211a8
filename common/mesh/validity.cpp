// The sign of Jacobians, exactly. Hexes are judged by Bezier coefficients and subdivision: A. Johnen, J.-C. Weill,
// J.-F. Remacle, Robust and efficient validation of the linear hexahedral element (IMR 2017). They subdivide the
// polynomial. Here the points are subdivided, which gives the same coefficients from one formula, because a subcell of
// a trilinear hex is a trilinear hex. A filter in doubles comes first; integers of any length, not expansions, then
// make the answer exact.

#include "common/mesh/validity.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/mesh/jacobian.hpp"

namespace hexpipe {
namespace {

constexpr int max_subdivisions = 4;  // rule 4
constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2;

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

struct IntegerVector {
  Integer x, y, z;
};
IntegerVector operator+(const IntegerVector& a, const IntegerVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
IntegerVector operator-(const IntegerVector& a, const IntegerVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Integer det(const IntegerVector& a, const IntegerVector& b, const IntegerVector& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

// mantissa * 2^exponent, with a whole mantissa. The exponent of zero is INT_MAX.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = std::numeric_limits<int>::max();

  explicit Dyadic(double value) {
    if (value == 0) return;
    constexpr int digits = std::numeric_limits<double>::digits;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
    exponent -= digits;
  }
};

// The points as integers on a common scale, which is a power of two.
template <std::size_t Count>
std::array<IntegerVector, Count> to_integers(std::span<const Vec3> points) {
  int lowest = std::numeric_limits<int>::max();
  for (const Vec3& p : points)
    for (int axis = 0; axis < 3; ++axis) lowest = std::min(lowest, Dyadic(p[axis]).exponent);
  auto whole = [lowest](double value) {
    const Dyadic d(value);
    return d.mantissa == 0 ? Integer(0) : Integer(d.mantissa) << (d.exponent - lowest);
  };
  std::array<IntegerVector, Count> result;
  for (std::size_t i = 0; i < Count; ++i) result[i] = {whole(points[i].x), whole(points[i].y), whole(points[i].z)};
  return result;
}

enum class Answer { no, yes, unsure };

// The rounding error of sums of determinants. The sums are counted in determinants of vectors whose components are at
// most `extent` along each axis. Such a determinant is a sum of 6 products; each product goes through fewer than 16
// roundings, including those of the differences and sums of points.
class ErrorBound {
 public:
  static constexpr double roundings = 16;

  ErrorBound(const Vec3& extent, double determinants, double roundings_of_each = roundings)
      : bound_(of_sum(determinants, roundings_of_each) * extent.x * extent.y * extent.z) {
    for (int axis = 0; axis < 3; ++axis)
      if (!(extent[axis] > smallest && extent[axis] < largest)) bound_ = std::numeric_limits<double>::infinity();
  }

  Answer positive(double value) const {
    return value > bound_ ? Answer::yes : value < -bound_ ? Answer::no : Answer::unsure;
  }

  // The factor that, multiplied by the extent along each axis, gives the bound.
  template <class Roundings>
  static constexpr Roundings of_sum(double determinants, const Roundings& roundings_of_each) {
    return determinants * 6 * roundings_of_each * epsilon;
  }
  // Beyond these limits, a product of two or three numbers may overflow or lose digits.
  static constexpr double smallest = 1e-90, largest = 1e90;

 private:
  double bound_;
};

// The largest determinant of a hex is that of an edge: two of its vectors are sums of two.
constexpr double determinants_at_edge = 4;
// The coefficient at the centre sums 12 determinants at edges and 5 times 8 at corners, with up to 24 additions.
constexpr double determinants_in_coefficient = 4 * (12 * 4 + 5 * 8);

double greater(double a, double b) {
  return std::max(a, b);
}
Lanes greater(const Lanes& a, const Lanes& b) {
  return select(a > b, a, b);
}

template <class Vector>
void extend(Vector& extent, const Vector& v) {
  extent.x = greater(extent.x, absolute(v.x));
  extent.y = greater(extent.y, absolute(v.y));
  extent.z = greater(extent.z, absolute(v.z));
}

template <class Vector>
Vector extent_of(const HexTangents<Vector>& t) {
  Vector extent;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      extend(extent, t.along_i[a][b]);
      extend(extent, t.along_j[a][b]);
      extend(extent, t.along_k[a][b]);
    }
  return extent;
}

using HexPoints = std::array<IntegerVector, 8>;

bool is_positive(const Integer& value) {
  return value.sign() > 0;
}

// unsure: positive at the 20 places, but the Bezier coefficients do not show that it is positive everywhere.
Answer judge_exactly(const HexPoints& points) {
  const HexJacobian<IntegerVector> jacobian{HexTangents<IntegerVector>(points)};
  if (!jacobian.all_determinants(is_positive)) return Answer::no;
  return std::ranges::all_of(jacobian.bezier(), is_positive) ? Answer::yes : Answer::unsure;
}

bool is_valid_exactly(const HexPoints& points, int subdivisions = 0) {
  const Answer answer = judge_exactly(points);
  if (answer != Answer::unsure) return answer == Answer::yes;
  if (subdivisions == max_subdivisions) return false;
  return std::ranges::all_of(split(points),
                             [&](const HexPoints& subcell) { return is_valid_exactly(subcell, subdivisions + 1); });
}

// A hex or a subcell of one, relative to a corner of the whole.
using RelativeHex = std::array<Vec3, 8>;

// A coordinate is off by one rounding of the largest one. Cutting adds up 8 points and multiplies coordinates by 8,
// which adds 8 roundings each time. Each of the three vectors of a determinant is off by twice as much.
template <class Vector>
auto roundings_of(const std::array<Vector, 8>& hex, const Vector& extent, int subdivisions) {
  Vector reach;
  for (const Vector& p : hex) extend(reach, p);
  const auto ratio = greater(greater(reach.x / extent.x, reach.y / extent.y), reach.z / extent.z);
  return ErrorBound::roundings + 2 * 3 * 2 * (1 + 8 * subdivisions) * ratio;
}

// Judges hexes with these tangents; each product of their determinants goes through this many roundings.
template <class Roundings>
LaneMask are_surely_valid(const HexTangents<LaneVector>& tangents, const LaneVector& extent,
                          const Roundings& roundings) {
  const HexJacobian<LaneVector> jacobian(tangents);
  const auto lesser = [](const Lanes& a, const Lanes& b) { return select(a < b, a, b); };
  Lanes determinant = jacobian.at_corner(0, 0, 0);
  jacobian.all_determinants([&](const Lanes& value) { return determinant = lesser(determinant, value), true; });
  Lanes coefficient = determinant;
  for (const Lanes& value : jacobian.bezier()) coefficient = lesser(coefficient, value);

  const Lanes bound = ErrorBound::of_sum(1, roundings) * extent.x * extent.y * extent.z;
  LaneMask sure = (determinant > determinants_at_edge * bound) & (coefficient > determinants_in_coefficient * bound);
  for (const Lanes& along_axis : {extent.x, extent.y, extent.z})
    sure &= (along_axis > ErrorBound::smallest) & (along_axis < ErrorBound::largest);
  return sure;
}

HEXPIPE_ANY_REGISTERS std::uint32_t surely_valid_subcells(const std::array<LaneVector, 8>& subcells, int subdivisions) {
  const HexTangents<LaneVector> tangents(subcells);
  const LaneVector extent = extent_of(tangents);
  return bits_of(are_surely_valid(tangents, extent, roundings_of(subcells, extent, subdivisions)));
}

Answer judge_in_doubles(const RelativeHex& hex, int subdivisions = 0) {
  const HexTangents<Vec3> tangents(hex);
  const Vec3 extent = extent_of(tangents);
  const double roundings = roundings_of(hex, extent, subdivisions);
  const HexJacobian<Vec3> jacobian(tangents);
  const ErrorBound determinant_bound(extent, determinants_at_edge, roundings);
  Answer answer = Answer::yes;
  jacobian.all_determinants([&](double value) {
    const Answer one = determinant_bound.positive(value);
    if (one != Answer::yes) answer = one;
    return one != Answer::no;
  });
  if (answer != Answer::yes) return answer;

  const ErrorBound coefficient_bound(extent, determinants_in_coefficient, roundings);
  auto surely_positive = [&](double value) { return coefficient_bound.positive(value) == Answer::yes; };
  if (std::ranges::all_of(jacobian.bezier(), surely_positive)) return Answer::yes;
  if (subdivisions == max_subdivisions) return Answer::unsure;
  const auto subcells = split(hex);
  static_assert(subcells.size() == lane_count);
  const std::uint32_t surely_valid = surely_valid_subcells(side_by_side(subcells), subdivisions + 1);
  for (int subcell = 0; subcell < lane_count; ++subcell) {
    if ((surely_valid >> subcell & 1) != 0) continue;
    const Answer one = judge_in_doubles(subcells[subcell], subdivisions + 1);
    if (one == Answer::no) return one;
    if (one == Answer::unsure) answer = one;
  }
  return answer;
}

bool is_valid_hex(std::span<const Vec3> corners) {
  RelativeHex hex;
  std::transform(corners.begin(), corners.end(), hex.begin(), [&](const Vec3& p) { return p - corners[0]; });
  const Answer answer = judge_in_doubles(hex);
  return answer == Answer::unsure ? is_valid_exactly(to_integers<8>(corners)) : answer == Answer::yes;
}

// Whether the quadratic with these Bezier coefficients is positive on [0, 1]. The middle coefficient may be negative.
template <class Number>
bool is_positive_quadratic(const std::array<Number, 3>& b) {
  if (b[0] <= 0 || b[2] <= 0) return false;
  return b[1] >= 0 || b[1] * b[1] < b[0] * b[2];
}

bool is_valid_prism(std::span<const Vec3> corners) {
  Vec3 extent;
  for (const auto& edge : PrismTopology::edges) extend(extent, corners[edge[1]] - corners[edge[0]]);
  const ErrorBound bound(extent, 2);
  bool all_yes = true;
  for (const auto& quadratic : prism_bezier<Vec3>(corners)) {
    for (const double value : quadratic) all_yes = all_yes && bound.positive(value) == Answer::yes;
    if (bound.positive(quadratic[0]) == Answer::no || bound.positive(quadratic[2]) == Answer::no) return false;
  }
  if (all_yes) return true;
  return std::ranges::all_of(prism_bezier<IntegerVector>(to_integers<6>(corners)), is_positive_quadratic<Integer>);
}

bool is_valid_pyramid(std::span<const Vec3> corners) {
  return std::ranges::all_of(PyramidTopology::corners, [&](const LocalCorner& c) {
    return orientation(corners[c[0]], corners[c[1]], corners[c[2]], corners[c[3]]) > 0;
  });
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  Vec3 extent;
  for (const Vec3& edge : {u, v, w}) extend(extent, edge);
  const Answer positive = ErrorBound(extent, 1).positive(det(u, v, w));
  if (positive != Answer::unsure) return positive == Answer::yes ? 1 : -1;
  const auto p = to_integers<4>(std::array{a, b, c, d});
  return det(p[1] - p[0], p[2] - p[0], p[3] - p[0]).sign();
}

// The tangents are differences of the given points; each is rounded once.
HEXPIPE_ANY_REGISTERS std::uint32_t surely_valid_hexes(const std::array<LaneVector, 8>& corners) {
  const HexTangents<LaneVector> tangents(corners);
  return bits_of(are_surely_valid(tangents, extent_of(tangents), ErrorBound::roundings));
}

bool is_valid(CellKind kind, std::span<const Vec3> corners) {
  switch (kind) {
    case CellKind::hex:
      return is_valid_hex(corners);
    case CellKind::prism:
      return is_valid_prism(corners);
    case CellKind::pyramid:
      return is_valid_pyramid(corners);
    case CellKind::tet:
      break;
  }
  return orientation(corners[0], corners[1], corners[2], corners[3]) > 0;
}

}  // namespace hexpipe
