#include "tools/tetmesh/geometry/box_tree.hpp"

#include <numeric>

#include "tools/tetmesh/geometry/triangle_slices.hpp"

namespace hexpipe::tetmesh::geometry {

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
