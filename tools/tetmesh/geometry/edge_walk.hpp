#pragma once
// The triangles at an edge, in the order of a walk around it.

#include <span>
#include <vector>

#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::geometry {

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
