#pragma once
// The nearest point of many triangles.

#include <cstdint>
#include <memory>

#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

struct NearestPoint {
  Vec3 point;
  std::int32_t triangle;
};

struct Plane {
  Vec3 point, normal;  // a unit normal
};

class TriangleTree {
 public:
  // Keeps no reference. Triangles without an area are left out; there must be others.
  explicit TriangleTree(const Surface& surface);
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  NearestPoint nearest(const Vec3& from) const;
  double distance(const Vec3& from) const { return norm(nearest(from).point - from); }

  // The plane of a triangle near `at`: its box comes nearer than `reach` along each axis. Among several, which are
  // equally near at a sharp edge, it is the triangle that faces `towards` most. The normal is turned to the side of
  // `towards`. Without such a triangle, the plane through `at` across `towards`.
  Plane facing_plane(const Vec3& at, const Vec3& towards, double reach) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace hexpipe::wrap
