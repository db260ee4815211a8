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
  const auto half_edge_count = static_cast<HalfEdge>(3 * triangles.size());
  auto ends = [&](HalfEdge h) { return std::minmax({start_of(triangles, h), end_of(triangles, h)}); };
  std::vector<HalfEdge> offsets(vertex_count + 1);
  for (HalfEdge h = 0; h < half_edge_count; ++h) ++offsets[ends(h).first + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) offsets[v + 1] += offsets[v];
  std::vector<HalfEdge> sorted(half_edge_count), next = offsets;
  for (HalfEdge h = 0; h < half_edge_count; ++h) sorted[next[ends(h).first]++] = h;

  std::vector<std::uint64_t> keys;  // of the half-edges at a vertex: the higher vertex, then the half-edge
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto at_vertex = std::span(sorted).subspan(offsets[v], offsets[v + 1] - offsets[v]);
    keys.clear();
    for (const HalfEdge h : at_vertex)
      keys.push_back(static_cast<std::uint64_t>(ends(h).second) << 32 | static_cast<std::uint32_t>(h));
    std::ranges::sort(keys);
    for (std::size_t i = 0; i < keys.size(); ++i) at_vertex[i] = static_cast<HalfEdge>(keys[i] & 0xffffffff);
    for (std::size_t begin = 0; begin < keys.size();) {
      std::size_t end = begin + 1;
      while (end < keys.size() && keys[end] >> 32 == keys[begin] >> 32) ++end;
      visit(at_vertex.subspan(begin, end - begin));
      begin = end;
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
