#pragma once
// Triangles that share points: what is wrapped, and what is wrapped around it.

#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::wrap {

struct Surface {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

}  // namespace hexpipe::wrap
