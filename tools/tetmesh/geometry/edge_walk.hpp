#pragma once
// The triangles at an edge in the order in which a walk around it meets them.

#include <span>
#include <vector>

#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::geometry {

struct EdgeWalkStep {
  double angle;  // around the edge, from the first half-edge's triangle
  HalfEdge half_edge;
  // Whether the half-edge leads from the edge's lower vertex to the higher one: then its triangle shows its normal to
  // those that come next, else its back.
  bool is_along;
};

// `edge`: all half-edges of an edge, of either direction.
std::vector<EdgeWalkStep> walk_around_edge(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                           std::span<const HalfEdge> edge);

}  // namespace hexpipe::tetmesh::geometry
