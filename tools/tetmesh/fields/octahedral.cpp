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

// A coordinate of all three axes of a frame; the fourth is zero.
using Lanes = Eigen::Array4d;

// Vectors, one for each axis of a frame.
struct LaneVectors {
  Lanes x, y, z;
};

LaneVectors lanes_of(const Frame& f) {
  return {{f[0].x, f[1].x, f[2].x, 0}, {f[0].y, f[1].y, f[2].y, 0}, {f[0].z, f[1].z, f[2].z, 0}};
}

Frame frame_of(const LaneVectors& lanes) {
  Frame frame;
  for (int i = 0; i < 3; ++i) frame[static_cast<std::size_t>(i)] = {lanes.x[i], lanes.y[i], lanes.z[i]};
  return frame;
}

// The function as a homogeneous polynomial of degree 4, by its coefficients: x3y is that of x x x y.
class Quartic {
 public:
  explicit Quartic(const Harmonics& a)
      : x4(3 * c0 * a[4] - c2 / 2 * a[6] + c4 / 4 * a[8]),
        y4(3 * c0 * a[4] + c2 / 2 * a[6] + c4 / 4 * a[8]),
        z4(8 * c0 * a[4]),
        x3y(c4 * a[0] - c2 * a[2]),
        xy3(-c4 * a[0] - c2 * a[2]),
        x3z(c3 * a[7] - 3 * c1 * a[5]),
        xz3(4 * c1 * a[5]),
        y3z(-c3 * a[1] - 3 * c1 * a[3]),
        yz3(4 * c1 * a[3]),
        x2y2(6 * c0 * a[4] - 1.5 * c4 * a[8]),
        x2z2(3 * c2 * a[6] - 24 * c0 * a[4]),
        y2z2(-3 * c2 * a[6] - 24 * c0 * a[4]),
        x2yz(3 * c3 * a[1] - 3 * c1 * a[3]),
        xy2z(-3 * c3 * a[7] - 3 * c1 * a[5]),
        xyz2(6 * c2 * a[2]) {}

  LaneVectors gradient_at(const LaneVectors& d) const {
    const Lanes xx = d.x * d.x, yy = d.y * d.y, zz = d.z * d.z, xyz = d.x * d.y * d.z;
    return {xx * (4 * x4 * d.x + 3 * x3y * d.y + 3 * x3z * d.z) + yy * (2 * x2y2 * d.x + xy3 * d.y + xy2z * d.z) +
                zz * (2 * x2z2 * d.x + xyz2 * d.y + xz3 * d.z) + 2 * x2yz * xyz,
            xx * (x3y * d.x + 2 * x2y2 * d.y + x2yz * d.z) + yy * (3 * xy3 * d.x + 4 * y4 * d.y + 3 * y3z * d.z) +
                zz * (xyz2 * d.x + 2 * y2z2 * d.y + yz3 * d.z) + 2 * xy2z * xyz,
            xx * (x3z * d.x + x2yz * d.y + 2 * x2z2 * d.z) + yy * (xy2z * d.x + y3z * d.y + 2 * y2z2 * d.z) +
                zz * (3 * xz3 * d.x + 3 * yz3 * d.y + 4 * z4 * d.z) + 2 * xyz2 * xyz};
  }

 private:
  double x4, y4, z4, x3y, xy3, x3z, xz3, y3z, yz3, x2y2, x2z2, y2z2, x2yz, xy2z, xyz2;
};

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

// Rotates around the vector by 2 atan(length / 2), which is close to the length while that is short and needs no sine
// (Cayley's map).
void rotate_by_cayley(LaneVectors& v, const Vec3& rotation) {
  const Vec3 h = 0.5 * rotation;
  const double scale = 2 / (1 + dot(h, h));
  const Lanes x = h.y * v.z - h.z * v.y, y = h.z * v.x - h.x * v.z, z = h.x * v.y - h.y * v.x;
  v.x += scale * (x + h.y * z - h.z * y);
  v.y += scale * (y + h.z * x - h.x * z);
  v.z += scale * (z + h.x * y - h.y * x);
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
  if (greatest == 0) return start;
  const Quartic quartic(function);
  LaneVectors axes = lanes_of(start);
  for (int step = 0; step < most_steps; ++step) {
    const LaneVectors g = quartic.gradient_at(axes);
    const double value = (g.x * axes.x + g.y * axes.y + g.z * axes.z).sum() / 4;  // Euler's theorem for degree 4
    const Vec3 torque{(axes.y * g.z - axes.z * g.y).sum(), (axes.z * g.x - axes.x * g.z).sum(),
                      (axes.x * g.y - axes.y * g.x).sum()};
    Vec3 rotation = torque * (1 / (curvature * std::max(value, 0.4 * greatest)));
    const double angle = norm(rotation);
    if (angle > longest_step) rotation *= longest_step / angle;
    rotate_by_cayley(axes, rotation);
    if (angle < close_enough) break;
  }
  Frame frame = frame_of(axes);
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
