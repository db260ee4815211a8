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
  double length = 0;        // walked
  bool at_feature = false;  // stopped by a feature edge
};

// Where a straight way leaves a triangle.
struct TriangleExit {
  geometry::HalfEdge edge = 0;
  double length = 0;  // of the way until there
};
TriangleExit exit_of(const FieldSurface& surface, const SurfacePoint& point, const Vec3& direction);

// How a direction goes on straight beyond an edge, with both triangles unfolded.
Vec3 unfolded_beyond(const FieldSurface& surface, geometry::HalfEdge edge, const Vec3& direction);

class FieldWalker {
 public:
  FieldWalker(const FieldSurface& surface, const CrossField& field) : surface_(surface), field_(field) {}

  // The direction of the field in a triangle that is nearest to the given one.
  Vec3 nearest_direction(std::int32_t triangle, const Vec3& direction) const;

  // Walks straight in each triangle, from one to the next with the direction of the field that continues the last,
  // until `length` is walked or a feature edge met.
  WalkEnd walk(const SurfacePoint& start, const Vec3& direction, double length) const {
    return go(start, direction, length, true);
  }

  // Straight on the surface, whatever the field.
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
