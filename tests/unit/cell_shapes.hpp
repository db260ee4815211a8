#pragma once
// Cells for tests of quality and validity: regular ones, and random ones around them.

#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/vec3.hpp"
#include "common/run/random.hpp"

namespace hexpipe {

// With Jacobian 1 (hex, prism: over their parameters) and right angles where the kind allows them.
inline std::vector<Vec3> unit_cell(CellKind kind) {
  switch (kind) {
    case CellKind::hex:
      return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    case CellKind::prism:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    case CellKind::pyramid:
      return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    case CellKind::tet:
      break;
  }
  return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

// Every coordinate of the unit cell moved by up to `amount`.
inline std::vector<Vec3> shaken_cell(CellKind kind, double amount, Random& random) {
  std::vector<Vec3> corners = unit_cell(kind);
  for (Vec3& p : corners) {
    p.x += random.uniform(-amount, amount);
    p.y += random.uniform(-amount, amount);
    p.z += random.uniform(-amount, amount);
  }
  return corners;
}

// The tangents of a cell's map at parameters (i, j, k) in [0, 1], written from its shape functions. Prism: i, j over
// the triangle, i + j <= 1. Pyramid: the base's tangents and the direction to the apex, the same at all heights.
struct Tangents {
  Vec3 i, j, k;
};

inline Tangents tangents_at(CellKind kind, const std::vector<Vec3>& p, double i, double j, double k) {
  auto mix = [](const Vec3& a, const Vec3& b, double t) { return (1 - t) * a + t * b; };
  if (kind == CellKind::tet) return {p[1] - p[0], p[2] - p[0], p[3] - p[0]};
  if (kind == CellKind::prism)
    return {mix(p[1] - p[0], p[4] - p[3], k), mix(p[2] - p[0], p[5] - p[3], k),
            (1 - i - j) * (p[3] - p[0]) + i * (p[4] - p[1]) + j * (p[5] - p[2])};
  const Vec3 base_i = mix(p[1] - p[0], p[2] - p[3], j), base_j = mix(p[3] - p[0], p[2] - p[1], i);
  const Vec3 base = mix(mix(p[0], p[1], i), mix(p[3], p[2], i), j);
  if (kind == CellKind::pyramid) return {base_i, base_j, p[4] - base};
  const Vec3 top_i = mix(p[5] - p[4], p[6] - p[7], j), top_j = mix(p[7] - p[4], p[6] - p[5], i);
  const Vec3 top = mix(mix(p[4], p[5], i), mix(p[7], p[6], i), j);
  return {mix(base_i, top_i, k), mix(base_j, top_j, k), top - base};
}

// visit(i, j, k) on a grid of (steps + 1)^3 parameters, those that the kind has.
template <class Visit>
void for_each_parameter(CellKind kind, int steps, Visit&& visit) {
  for (int a = 0; a <= steps; ++a)
    for (int b = 0; b <= (kind == CellKind::prism ? steps - a : steps); ++b)
      for (int c = 0; c <= (kind == CellKind::pyramid ? 0 : steps); ++c)
        visit(double(a) / steps, double(b) / steps, double(c) / steps);
}

}  // namespace hexpipe
