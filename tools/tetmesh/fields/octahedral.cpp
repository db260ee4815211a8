#include "tools/tetmesh/fields/octahedral.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::tetmesh::fields {
namespace {

// The harmonics as polynomials, times sqrt(4 pi / 9). Any table has them, for example that of Huang et al. 2011.
constexpr double c4 = 2.9580398915498081;   // sqrt(35) / 2
constexpr double c3 = 2.0916500663351889;   // sqrt(35 / 2) / 2
constexpr double c2 = 1.1180339887498949;   // sqrt(5) / 2
constexpr double c1 = 0.79056941504209488;  // sqrt(5 / 2) / 2
constexpr double c0 = 0.125;

// The gradient of the function as a homogeneous polynomial of degree 4.
Vec3 gradient_at(const Harmonics& a, const Vec3& d) {
  const double x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
  Vec3 g{};
  const double m4 = c4 * a[0];
  g += m4 * Vec3{y * (3 * xx - yy), x * (xx - 3 * yy), 0};
  const double m3 = c3 * a[1];
  g += m3 * Vec3{6 * x * y * z, 3 * (xx - yy) * z, y * (3 * xx - yy)};
  const double m2 = c2 * a[2];
  g += m2 * Vec3{y * (6 * zz - 3 * xx - yy), x * (6 * zz - xx - 3 * yy), 12 * x * y * z};
  const double m1 = c1 * a[3];
  g += m1 * Vec3{-6 * x * y * z, z * (4 * zz - 3 * xx - 9 * yy), y * (12 * zz - 3 * xx - 3 * yy)};
  const double p0 = c0 * a[4];
  const double rr = xx + yy;
  g += p0 * Vec3{x * (12 * rr - 48 * zz), y * (12 * rr - 48 * zz), z * (32 * zz - 48 * rr)};
  const double p1 = c1 * a[5];
  g += p1 * Vec3{z * (4 * zz - 9 * xx - 3 * yy), -6 * x * y * z, x * (12 * zz - 3 * xx - 3 * yy)};
  const double p2 = c2 / 2 * a[6];
  g += p2 * Vec3{x * (12 * zz - 4 * xx), y * (4 * yy - 12 * zz), 12 * z * (xx - yy)};
  const double p3 = c3 * a[7];
  g += p3 * Vec3{3 * (xx - yy) * z, -6 * x * y * z, x * (xx - 3 * yy)};
  const double p4 = c4 / 4 * a[8];
  g += p4 * Vec3{4 * x * (xx - 3 * yy), 4 * y * (yy - 3 * xx), 0};
  return g;
}

double value_of(const Harmonics& function, const Frame& frame) {
  return value_at(function, frame[0]) + value_at(function, frame[1]) + value_at(function, frame[2]);
}

// Rotates around the vector by its length (Rodrigues).
Frame rotated(const Frame& frame, const Vec3& rotation) {
  const double angle = norm(rotation);
  if (angle == 0) return frame;
  const Vec3 axis = rotation * (1 / angle);
  const double sine = std::sin(angle), cosine = std::cos(angle);
  Frame turned;
  for (std::size_t i = 0; i < 3; ++i)
    turned[i] = cosine * frame[i] + sine * cross(axis, frame[i]) + (1 - cosine) * dot(axis, frame[i]) * axis;
  return turned;
}

void orthonormalize(Frame& frame) {
  frame[0] = unit(frame[0]);
  frame[1] = unit(frame[1] - dot(frame[1], frame[0]) * frame[0]);
  const Vec3 third = cross(frame[0], frame[1]);
  frame[2] = dot(third, frame[2]) < 0 ? -third : third;
}

}  // namespace

Harmonics harmonics_of_axis(const Vec3& d) {
  const double x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z, rr = xx + yy;
  Harmonics a;
  a << c4 * x * y * (xx - yy), c3 * y * z * (3 * xx - yy), c2 * x * y * (6 * zz - rr), c1 * y * z * (4 * zz - 3 * rr),
      c0 * (8 * zz * zz - 24 * zz * rr + 3 * rr * rr), c1 * x * z * (4 * zz - 3 * rr),
      c2 / 2 * (xx - yy) * (6 * zz - rr), c3 * x * z * (xx - 3 * yy), c4 / 4 * (xx * xx - 6 * xx * yy + yy * yy);
  return a;
}

Harmonics harmonics_of(const Frame& frame) {
  return harmonics_of_axis(frame[0]) + harmonics_of_axis(frame[1]) + harmonics_of_axis(frame[2]);
}

Harmonics harmonics_of_cross(const Vec3& normal, const Vec3& first) {
  return harmonics_of_axis(first) + harmonics_of_axis(cross(normal, first)) -
         (common_part - 1) * harmonics_of_axis(normal);
}

double value_at(const Harmonics& function, const Vec3& direction) {
  return function.dot(harmonics_of_axis(direction));
}

Frame climb_to_frame(const Harmonics& function, const Frame& start) {
  // At the frame of a function c (x^4 + y^4 + z^4 - 3/5), the value is 1.2 c and the curvature is 8 c in any direction.
  // This gives Newton's step for the function of a frame, and a safe step for others.
  // After a turn by close_enough the value is as good as greatest: it lacks 2 squares of the angle that is left.
  constexpr double curvature = 8 / 1.2, longest_step = 0.35, close_enough = 1e-4;
  constexpr int most_steps = 40;
  const double greatest = std::sqrt(function.squaredNorm() * frame_norm_squared);
  Frame frame = start;
  if (greatest == 0) return frame;
  for (int step = 0; step < most_steps; ++step) {
    Vec3 torque;
    double value = 0;
    for (const Vec3& axis : frame) {
      const Vec3 gradient = gradient_at(function, axis);
      value += dot(gradient, axis) / 4;  // Euler's theorem for degree 4
      torque += cross(axis, gradient);
    }
    Vec3 rotation = torque * (1 / (curvature * std::max(value, 0.4 * greatest)));
    const double angle = norm(rotation);
    if (angle > longest_step) rotation *= longest_step / angle;
    frame = rotated(frame, rotation);
    if (angle < close_enough) break;
  }
  orthonormalize(frame);
  return frame;
}

Frame nearest_frame(const Harmonics& function) {
  // The axes; the axes turned by 45 degrees about each of them; the axes turned by 60 degrees about a diagonal.
  constexpr double s = 0.70710678118654752;
  static constexpr std::array<Frame, 5> starts{
      Frame{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, Frame{Vec3{1, 0, 0}, {0, s, s}, {0, -s, s}},
      Frame{Vec3{s, 0, s}, {0, 1, 0}, {-s, 0, s}}, Frame{Vec3{s, s, 0}, {-s, s, 0}, {0, 0, 1}},
      Frame{Vec3{2. / 3, 2. / 3, -1. / 3}, {-1. / 3, 2. / 3, 2. / 3}, {2. / 3, -1. / 3, 2. / 3}}};
  Frame best{};
  double best_value = -1;
  // The function of a frame is greatest at the frame. A function that comes close to that has no second hill as high.
  constexpr double surely_greatest = 0.95;
  const double greatest = std::sqrt(function.squaredNorm() * frame_norm_squared);
  for (const Frame& start : starts) {
    const Frame frame = climb_to_frame(function, start);
    const double value = value_of(function, frame);
    if (value <= best_value * (1 + 1e-7)) continue;  // the same hill
    best = frame;
    best_value = value;
    if (value > surely_greatest * greatest) break;
  }
  return best_value < 0 ? starts[0] : best;
}

Frame turned_onto(const Frame& frame, const Vec3& direction) {
  const auto nearest =
      std::ranges::max_element(frame, {}, [&](const Vec3& axis) { return std::abs(dot(axis, direction)); });
  const double cosine = dot(*nearest, direction);
  const Vec3 target = cosine < 0 ? -direction : direction;
  const Vec3 around = cross(*nearest, target);
  const double sine = norm(around);
  Frame turned = frame;
  if (sine > 0) turned = rotated(frame, around * (std::atan2(sine, std::abs(cosine)) / sine));
  return turned;
}

Frame frame_around(const Vec3& direction) {
  const Vec3 helper = std::abs(direction.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 second = unit(cross(direction, helper));
  return {direction, second, cross(direction, second)};
}

}  // namespace hexpipe::tetmesh::fields
