#include "tools/tetmesh/geometry/triangle_boxes.hpp"

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

BoxTree tree_of_triangles(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  const double length = length_of_slices(points, triangles);
  std::vector<Box> boxes;
  std::vector<std::int32_t> owners;
  boxes.reserve(triangles.size());
  owners.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    TriangleSlices(points[a], points[b], points[c], length).for_each_box([&](const Box& box) {
      boxes.push_back(box);
      owners.push_back(static_cast<std::int32_t>(i));
    });
  }
  return {boxes, std::vector<double>(boxes.size(), 0.0), owners};
}

}  // namespace hexpipe::tetmesh::geometry
