#pragma once
// The triangles around each point of a surface, and steps that change it in one place.

#include <cstdint>
#include <vector>

#include "tools/wrap/shrink_wrap.hpp"
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

// Leaves out the triangles with two equal corners.
void leave_out_merged_triangles(Surface& surface);

// Takes steps that leave the surface without crossings. take() changes the surface by steps that do not touch each
// other, and returns them. If the surface crosses itself then, all of them are taken back, forbid(step) is called for
// the steps at a crossing, and take() tries again. is_at(step, crosses) tells whether a step is at one; `crosses` has
// an entry for each point. False if no step is left.
template <class Take, class IsAt, class Forbid>
bool take_without_crossings(Surface& surface, Take&& take, IsAt&& is_at, Forbid&& forbid) {
  for (;;) {
    const Surface before = surface;
    const auto& steps = take();
    if (steps.empty()) return false;
    const auto crossing = crossing_triangles(surface);
    if (crossing.empty()) return true;
    std::vector<char> crosses(surface.points.size());
    for (const std::int32_t t : crossing)
      for (const Vertex v : surface.triangles[t]) crosses[v] = true;
    bool blamed = false;
    for (const auto& step : steps)
      if (is_at(step, crosses)) forbid(step), blamed = true;
    // A triangle beside the steps crosses: all of them are suspect.
    if (!blamed)
      for (const auto& step : steps) forbid(step);
    surface = before;
  }
}

}  // namespace hexpipe::wrap
