#include "tools/tetmesh/geometry/half_edges.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

namespace hexpipe::tetmesh::geometry {

void for_each_edge(std::size_t vertex_count, std::span<const Triangle> triangles,
                   const std::function<void(std::span<const HalfEdge>)>& visit) {
  // A counting sort by the lower vertex leaves a handful of half-edges to sort by the higher one.
  const auto for_each_half_edge = [&](auto&& take) {
    HalfEdge h = 0;
    for (const auto& [a, b, c] : triangles)
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        take(std::min(from, to), std::max(from, to), h++);
  };
  std::vector<HalfEdge> ends(vertex_count + 1);  // by vertex: where its half-edges begin, and end once they are there
  for_each_half_edge([&](Vertex low, Vertex, HalfEdge) { ++ends[low + 1]; });
  for (std::size_t v = 0; v < vertex_count; ++v) ends[v + 1] += ends[v];
  std::vector<std::uint64_t> keys(3 * triangles.size());  // the higher vertex, then the half-edge
  for_each_half_edge([&](Vertex low, Vertex high, HalfEdge h) {
    keys[ends[low]++] = static_cast<std::uint64_t>(high) << 32 | static_cast<std::uint32_t>(h);
  });

  std::vector<HalfEdge> edge;
  std::size_t begin = 0;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const std::size_t last = ends[v];
    std::sort(keys.begin() + begin, keys.begin() + last);
    while (begin < last) {
      const std::uint64_t high = keys[begin] >> 32;
      edge.clear();
      for (; begin < last && keys[begin] >> 32 == high; ++begin)
        edge.push_back(static_cast<HalfEdge>(keys[begin] & 0xffffffff));
      visit(edge);
    }
  }
}

std::vector<HalfEdge> find_twins(std::size_t vertex_count, std::span<const Triangle> triangles) {
  std::vector<HalfEdge> twins(3 * triangles.size());
  for_each_edge(vertex_count, triangles, [&](std::span<const HalfEdge> edge) {
    assert(edge.size() == 2);
    twins[edge[0]] = edge[1];
    twins[edge[1]] = edge[0];
  });
  return twins;
}

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
