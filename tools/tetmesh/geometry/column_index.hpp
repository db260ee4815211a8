#pragma once
// Decides exactly which shells of a surface enclose a point.
//
// A shell encloses a point if a ray from the point crosses the shell an odd number of times. The ray goes up along z.
// Ties in the projection are decided as if the point were moved by an infinitely small step in y and a still smaller
// one in x. Each edge is decided once for both of its triangles, so that no ray slips through between them. A grid over
// x and y finds the triangles above the point.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::geometry {

class ColumnIndex {
 public:
  // The arrays must outlive the index.
  ColumnIndex(std::span<const Vec3> points, std::span<const Triangle> triangles);

  // Calls visit(triangle) for each triangle that the ray upwards from p crosses. The ray does not cross a triangle
  // through p itself.
  template <class Visit>
  void for_each_crossing(const Vec3& p, Visit&& visit) const {
    for (const std::int32_t t : column_of(p))
      if (is_crossed(p, t)) visit(t);
  }

 private:
  std::span<const std::int32_t> column_of(const Vec3& p) const;
  bool is_crossed(const Vec3& p, std::int32_t triangle) const;
  std::int64_t column_number(double value, int axis) const;
  template <class Visit>
  void for_each_column(const Triangle& triangle, Visit&& visit) const;

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  double low_[2] = {}, width_[2] = {};
  std::int64_t counts_[2] = {};
  std::vector<std::int64_t> offsets_;
  std::vector<std::int32_t> members_;
};

}  // namespace hexpipe::tetmesh::geometry
