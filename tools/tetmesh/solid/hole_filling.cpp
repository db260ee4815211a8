#include "tools/tetmesh/solid/hole_filling.hpp"

#include <limits>

namespace hexpipe::tetmesh::solid {

std::vector<Triangle> triangulate_polygon(std::span<const Vec3> points, std::span<const Vertex> corners) {
  const std::size_t n = corners.size();
  const auto at = [n](std::size_t i, std::size_t j) { return i * n + j; };
  const auto area = [&](std::size_t i, std::size_t j, std::size_t k) {
    const Vec3& origin = points[corners[i]];
    return norm(cross(points[corners[j]] - origin, points[corners[k]] - origin));
  };
  // Of the part of the polygon from corner i to corner j: its least area, and the third corner at the side from i to j.
  std::vector<double> least(n * n);
  std::vector<std::size_t> apex(n * n);
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      least[at(i, j)] = std::numeric_limits<double>::infinity();
      for (std::size_t k = i + 1; k < j; ++k) {
        const double sum = least[at(i, k)] + least[at(k, j)] + area(i, k, j);
        if (sum >= least[at(i, j)]) continue;
        least[at(i, j)] = sum;
        apex[at(i, j)] = k;
      }
    }
  std::vector<Triangle> triangles;
  std::vector<std::pair<std::size_t, std::size_t>> parts{{0, n - 1}};
  while (!parts.empty()) {
    const auto [i, j] = parts.back();
    parts.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex[at(i, j)];
    triangles.push_back({corners[i], corners[k], corners[j]});
    parts.emplace_back(i, k);
    parts.emplace_back(k, j);
  }
  return triangles;
}

}  // namespace hexpipe::tetmesh::solid
