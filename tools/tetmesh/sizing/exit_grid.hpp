#pragma once
// Tells for most short rays that go into the material that they do not leave it, without looking at a triangle.
//
// A ray that starts in the material first meets a triangle from behind: one whose normal does not point against it. So
// a grid of cells suffices, each of which knows roughly which normals its triangles have. On a scan, where triangles
// are far shorter than the rays, all normals around the start of most rays point against them. A ray that leaves
// through a wall thinner than rounding may meet another wall from the front; that one is no wall of this material.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::sizing {

// Directions in classes: the sides of a cube around the origin, each cut into parts² squares.
class DirectionClasses {
 public:
  explicit DirectionClasses(int parts) : parts_(parts) {}

  int count() const { return 6 * parts_ * parts_; }
  // The direction may have any length but 0.
  int of(const Vec3& direction) const;
  // The axis has length 1; no direction of the class is further from it than the angle, in radians.
  struct Cone {
    Vec3 axis;
    double angle;
  };
  Cone cone_of(int number) const;

 private:
  int parts_;
};

class ExitGrid {
 public:
  // `reach` is how long rays are. The surface has to be closed, with the material behind its triangles.
  ExitGrid(std::span<const Vec3> points, std::span<const Triangle> triangles, double reach);

  // False if a ray along `direction` (of length 1) that starts at a triangle, and goes into the material, certainly
  // does not leave it within the reach.
  bool may_leave(const Vec3& from, const Vec3& direction) const;

 private:
  using Classes = std::uint64_t;  // a set of classes of normals

  struct Cells {
    std::array<std::int64_t, 3> low, high;
  };
  // Those that the box around two points reaches; the box is a little larger, for rounding.
  Cells cells_around(const Vec3& low, const Vec3& high) const;
  template <class Visit>
  void for_each_in(const Cells& cells, Visit&& visit) const;
  Classes classes_of(const Vec3& a, const Vec3& b, const Vec3& c) const;

  DirectionClasses of_normals_, of_rays_;
  std::vector<Classes> from_behind_;  // by class of rays: the normals of triangles that such a ray may meet from behind
  double reach_, width_ = 0;
  Vec3 low_;
  std::array<std::int64_t, 3> counts_{};
  std::vector<Classes> normals_;  // by cell
};

}  // namespace hexpipe::tetmesh::sizing
