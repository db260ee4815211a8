#pragma once
// What lies around the points of a surface, for steps that change it in one place.

#include <cstdint>
#include <vector>

#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

// The triangles at each point.
using TrianglesAround = std::vector<std::vector<std::int32_t>>;
TrianglesAround triangles_around(const Surface& surface);

inline bool has(const Triangle& t, Vertex v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

// The other points of the triangles `around` v, ascending.
std::vector<Vertex> neighbours(const Surface& surface, const std::vector<std::int32_t>& around, Vertex v);

// On a closed surface an edge may be merged when its ends have two neighbours in common, those opposite it.
bool may_merge(const Surface& surface, const TrianglesAround& around, Vertex v, Vertex w);

// The triangles with two equal corners go.
void leave_out_merged_triangles(Surface& surface);

}  // namespace hexpipe::wrap
