#include "tools/tetmesh/geometry/triangle_slices.hpp"

namespace hexpipe::tetmesh::geometry {

double length_of_slices(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  constexpr double most_slices = 64;
  double area = 0, length = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 ab = points[b] - points[a], ac = points[c] - points[a];
    area += norm(cross(ab, ac));
    length += std::sqrt(std::max({norm_squared(ab), norm_squared(ac), norm_squared(ac - ab)}));
  }
  const auto count = static_cast<double>(triangles.size());
  return std::max(std::sqrt(area / count), length / (most_slices * count));
}

}  // namespace hexpipe::tetmesh::geometry
