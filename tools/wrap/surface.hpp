#pragma once
// Triangles that share points: what is wrapped, and what is wrapped around it; and how far they are from each other.

#include <cstdint>
#include <memory>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::wrap {

struct Surface {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

struct NearestPoint {
  Vec3 point;
  std::int32_t triangle;
};

struct Plane {
  Vec3 point, normal;  // a unit normal
};

// The nearest point of many triangles.
class TriangleTree {
 public:
  // Keeps no reference. Triangles without an area are left out; there must be others.
  explicit TriangleTree(const Surface& surface);
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  NearestPoint nearest(const Vec3& from) const;
  double distance(const Vec3& from) const { return norm(nearest(from).point - from); }

  // The plane of the nearest triangle. The normal is turned to the side of `towards`.
  Plane nearest_plane(const Vec3& from, const Vec3& towards) const;

  // The plane of a triangle near `at`: its box comes nearer than `reach` along each axis. Among several, which are
  // equally near at a sharp edge, it is the triangle that faces `towards` most. The normal is turned to the side of
  // `towards`. Without such a triangle, the plane through `at` across `towards`.
  Plane facing_plane(const Vec3& at, const Vec3& towards, double reach) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

// How far two surfaces are from each other, one way.
struct DistanceSummary {
  double greatest = 0, mean = 0;  // the mean is over the area
  double share_beyond = 0;        // of the area that is farther away than the limit
};

// From points of `surface` that are at most `spacing` apart to the triangles of `other`.
DistanceSummary distances(const Surface& surface, const TriangleTree& other, double spacing, double limit);

}  // namespace hexpipe::wrap
