#pragma once
// A point or a vector in space: three doubles in a row, so an array of them is an (n,3) array of f8.

#include <cmath>

namespace hexpipe {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr Vec3& operator+=(const Vec3& b) { return x += b.x, y += b.y, z += b.z, *this; }
  constexpr Vec3& operator-=(const Vec3& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
  constexpr Vec3& operator*=(double s) { return x *= s, y *= s, z *= s, *this; }
  constexpr bool operator==(const Vec3&) const = default;
};
static_assert(sizeof(Vec3) == 3 * sizeof(double));

constexpr Vec3 operator+(Vec3 a, const Vec3& b) {
  return a += b;
}
constexpr Vec3 operator-(Vec3 a, const Vec3& b) {
  return a -= b;
}
constexpr Vec3 operator*(Vec3 a, double s) {
  return a *= s;
}
constexpr Vec3 operator*(double s, Vec3 a) {
  return a *= s;
}
constexpr Vec3 operator-(const Vec3& a) {
  return {-a.x, -a.y, -a.z};
}

constexpr double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// The determinant of the matrix with rows a, b, c: six times the volume of the tet that they span.
constexpr double det(const Vec3& a, const Vec3& b, const Vec3& c) {
  return dot(a, cross(b, c));
}
constexpr double norm_squared(const Vec3& a) {
  return dot(a, a);
}
inline double norm(const Vec3& a) {
  return std::sqrt(norm_squared(a));
}
// In radians, with full precision near 0 and pi, too; 0 if one vector vanishes.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}
// The unit vector in the direction of a; zero if a is zero or too short for its square to differ from zero.
inline Vec3 unit(const Vec3& a) {
  const double length = norm(a);
  return length > 0 ? a * (1 / length) : Vec3{};
}

// Squares of determinants of points within this bound are finite.
inline constexpr double largest_coordinate = 1e50;
// False for NaN, too.
inline bool is_place(const Vec3& a) {
  return std::abs(a.x) <= largest_coordinate && std::abs(a.y) <= largest_coordinate &&
         std::abs(a.z) <= largest_coordinate;
}

}  // namespace hexpipe
