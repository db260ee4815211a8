#pragma once
// A tetrahedral mesh with its regions and its tagged boundary and interface triangles. tetmesh makes it and findhex
// starts from it.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/index.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// A plain number, as files hold it: vertices meet everything, and most arrays of a mesh consist of them.
using Vertex = std::int32_t;
using TetIndex = Index<struct TetKind>;
using Tet = std::array<Vertex, 4>;
using Triangle = std::array<Vertex, 3>;
using Quad = std::array<Vertex, 4>;
using Ridge = std::array<Vertex, 2>;

struct TetMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;                    // positively oriented: det(01, 02, 03) > 0
  std::vector<std::int32_t> tet_tags;       // region of each tet
  std::vector<Triangle> triangles;          // boundary and interfaces between regions
  std::vector<std::int32_t> triangle_tags;  // surface tag of each triangle
  // Edges of the surface that are sharp at any angle, if the mesh names some; empty in a part that has none.
  std::optional<std::vector<Ridge>> ridges{};

  bool operator==(const TetMesh&) const = default;
};

// Six times the signed volume.
inline double tet_determinant(std::span<const Vec3> points, const Tet& t) {
  const Vec3& o = points[t[0]];
  return det(points[t[1]] - o, points[t[2]] - o, points[t[3]] - o);
}

// Throws DataError naming `source` when arrays disagree in length, an index is out of range, a tet or triangle repeats
// a vertex, or a coordinate is not finite. It does not judge orientation: see tet_determinant.
void validate(const TetMesh& mesh, const char* source);

}  // namespace hexpipe
