#pragma once
// Which triangles of a soup meet at each edge. Half-edge 3 t + i leads from corner i of triangle t to corner i + 1.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::geometry {

using HalfEdge = std::int32_t;

inline std::int32_t triangle_of(HalfEdge h) {
  return h / 3;
}
inline HalfEdge next_in_triangle(HalfEdge h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
inline HalfEdge previous_in_triangle(HalfEdge h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

inline Vertex start_of(std::span<const Triangle> triangles, HalfEdge h) {
  return triangles[h / 3][h % 3];
}
inline Vertex end_of(std::span<const Triangle> triangles, HalfEdge h) {
  return start_of(triangles, next_in_triangle(h));
}

// The corner across a half-edge in its triangle.
inline Vertex corner_across(std::span<const Triangle> triangles, HalfEdge h) {
  return start_of(triangles, previous_in_triangle(h));
}

// Calls visit once for every edge with all of its half-edges, of either direction, in ascending order. Edges are
// ordered by their lower vertex, then by their higher one. No triangle may repeat a vertex.
void for_each_edge(std::size_t vertex_count, std::span<const Triangle> triangles,
                   const std::function<void(std::span<const HalfEdge>)>& visit);

// The other half-edge of each edge; every edge must have two.
std::vector<HalfEdge> find_twins(std::size_t vertex_count, std::span<const Triangle> triangles);

struct EdgeWalkStep {
  double angle;  // around the edge, from the triangle of the first half-edge
  HalfEdge half_edge;
  // Whether the half-edge leads from the edge's lower vertex to the higher one. If so, its triangle shows its normal to
  // the triangles that come next, otherwise its back.
  bool is_along;
};

// `edge` holds all half-edges of an edge, of either direction.
std::vector<EdgeWalkStep> walk_around_edge(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                           std::span<const HalfEdge> edge);

}  // namespace hexpipe::tetmesh::geometry
