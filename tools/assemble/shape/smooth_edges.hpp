#pragma once
// The rule by which an edge is smooth, for surfaces of any kind.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/defaults.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble::shape {

// The unit vector from edge ab to c, at right angles to the edge.
inline Vec3 away_from_edge(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 along = unit(b - a);
  return unit((c - a) - along * dot(c - a, along));
}
// The same for a triangle that has the edge.
inline Vec3 away_from_edge(std::span<const Vec3> points, const Triangle& triangle, const VertexKey<2>& edge) {
  for (const Vertex v : triangle)
    if (v != edge[0] && v != edge[1]) return away_from_edge(points[edge[0]], points[edge[1]], points[v]);
  return {};
}

// An edge is smooth if it has just two facets, with one tag, and the surface turns there by less than the default
// feature angle: cylinders of nine sides and more are smooth. away_of(facet) is the vector from the edge into the
// facet, as away_from_edge() has it.
template <class AwayOf>
bool is_smooth_edge(std::span<const std::int32_t> facets, const std::vector<std::int32_t>& tags, AwayOf&& away_of) {
  return facets.size() == 2 && tags[facets[0]] == tags[facets[1]] &&
         dot(away_of(facets[0]), away_of(facets[1])) < -cosine_of_degrees(default_feature_angle);
}

}  // namespace hexpipe::assemble::shape
