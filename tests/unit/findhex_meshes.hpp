#pragma once
// Small tet meshes whose candidates are known.

#include <algorithm>
#include <array>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::testing {

// The unit cube's corners in the hex numbering.
inline std::vector<Vec3> cube_points() {
  return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
}

// Around the diagonal 06; the quads have the diagonals at 0 and 6.
inline std::vector<Tet> six_tets() {
  return {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
}

// The quads have the diagonals between 0, 2, 5 and 7.
inline std::vector<Tet> five_tets() {
  return {{0, 2, 7, 5}, {1, 2, 0, 5}, {3, 0, 2, 7}, {4, 7, 5, 0}, {6, 5, 7, 2}};
}

// All in region 1, without surface triangles. Lists tets in the positive sense.
inline TetMesh mesh_of(std::vector<Vec3> points, std::vector<Tet> tets) {
  TetMesh mesh;
  mesh.points = std::move(points);
  mesh.tets = std::move(tets);
  for (Tet& tet : mesh.tets)
    if (tet_determinant(mesh.points, tet) < 0) std::swap(tet[2], tet[3]);
  mesh.tet_tags.assign(mesh.tets.size(), 1);
  return mesh;
}

// As tests/data/lattices/lattice.py kuhn n, but all tets positive.
inline TetMesh kuhn_lattice(int n) {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  auto vertex = [n](int i, int j, int k) { return (i * (n + 1) + j) * (n + 1) + k; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) points.push_back({double(i), double(j), double(k)});
  for (int cube = 0; cube < n * n * n; ++cube) {
    std::array<int, 3> axes{0, 1, 2};
    do {
      std::array<int, 3> at{cube / (n * n), cube / n % n, cube % n};
      Tet tet{vertex(at[0], at[1], at[2])};
      for (int step = 0; step < 3; ++step) {
        ++at[axes[step]];
        tet[step + 1] = vertex(at[0], at[1], at[2]);
      }
      tets.push_back(tet);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  return mesh_of(std::move(points), std::move(tets));
}

}  // namespace hexpipe::testing
