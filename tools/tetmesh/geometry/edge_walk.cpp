#include "tools/tetmesh/geometry/edge_walk.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace hexpipe::tetmesh::geometry {

std::vector<EdgeWalkStep> walk_around_edge(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                           std::span<const HalfEdge> edge) {
  const auto [low, high] = std::minmax({start_of(triangles, edge[0]), end_of(triangles, edge[0])});
  const Vec3& from = points[low];
  const Vec3 axis = unit(points[high] - from);
  std::vector<EdgeWalkStep> steps;
  std::optional<Vec3> first;
  for (const HalfEdge h : edge) {
    Vec3 away = points[end_of(triangles, next_in_triangle(h))] - from;
    away = unit(away - dot(away, axis) * axis);
    if (!first) first = away;
    const double angle = std::atan2(dot(away, cross(axis, *first)), dot(away, *first));
    steps.push_back({angle, h, start_of(triangles, h) == low});
  }
  std::ranges::sort(steps, {}, [](const EdgeWalkStep& s) { return std::pair(s.angle, s.half_edge); });
  return steps;
}

}  // namespace hexpipe::tetmesh::geometry
