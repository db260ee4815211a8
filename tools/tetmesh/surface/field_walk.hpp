#pragma once
// Walks on a surface along its cross field.

#include "tools/tetmesh/surface/cross_field.hpp"

namespace hexpipe::tetmesh::surface {

struct SurfacePoint {
  Vec3 position;
  std::int32_t triangle = 0;
};

struct WalkEnd {
  SurfacePoint point;
  Vec3 heading;             // at the end
  double length = 0;        // the length of the way
  bool at_feature = false;  // a feature edge stopped the walk
};

// Where a straight way leaves a triangle.
struct TriangleExit {
  geometry::HalfEdge edge = 0;
  double length = 0;  // of the way up to there
};
TriangleExit exit_of(const FieldSurface& surface, const SurfacePoint& point, const Vec3& direction);

// How a direction continues straight beyond an edge, with both triangles unfolded into one plane.
Vec3 unfolded_beyond(const FieldSurface& surface, geometry::HalfEdge edge, const Vec3& direction);

// Walks straight from triangle to triangle, up to a feature edge or as long as visit(point, direction, exit) says,
// which is called in each triangle; and over at most 1000 of them: more are needles without a width.
template <class Visit>
void walk_straight_over(const FieldSurface& surface, SurfacePoint at, Vec3 direction, Visit&& visit) {
  constexpr int most_triangles = 1000;
  for (int i = 0; i < most_triangles; ++i) {
    const TriangleExit exit = exit_of(surface, at, direction);
    if (!visit(at, direction, exit) || surface.feature[exit.edge]) return;
    at = {at.position + exit.length * direction, geometry::triangle_of(surface.twins[exit.edge])};
    direction = unfolded_beyond(surface, exit.edge, direction);
  }
}

class FieldWalker {
 public:
  FieldWalker(const FieldSurface& surface, const CrossField& field) : surface_(surface), field_(field) {}

  // The direction of the field in a triangle that is nearest to the given one.
  Vec3 nearest_direction(std::int32_t triangle, const Vec3& direction) const;

  // Walks straight within each triangle. In the next triangle it follows the direction of the field that continues the
  // last one. It ends after `length`, or at a feature edge.
  WalkEnd walk(const SurfacePoint& start, const Vec3& direction, double length) const {
    return go(start, direction, length, true);
  }

  // Walks straight on the surface and ignores the field.
  WalkEnd walk_straight(const SurfacePoint& start, const Vec3& direction, double length) const {
    return go(start, direction, length, false);
  }

 private:
  WalkEnd go(const SurfacePoint& start, const Vec3& direction, double length, bool along_field) const;
  Vec3 field_beyond(geometry::HalfEdge edge, const Vec3& direction) const;

  const FieldSurface& surface_;
  const CrossField& field_;
};

}  // namespace hexpipe::tetmesh::surface
