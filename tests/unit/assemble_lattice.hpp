#pragma once
// Lattices of cubes cut into six tets each around one diagonal, every cube a candidate: enough to choose from without a
// search.

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/run/random.hpp"

namespace hexpipe::testing {
using namespace graph;

struct Lattice {
  int n;
  TetMesh mesh;
  Candidates cubes;  // cube (i, j, k) is candidate (i n + j) n + k
};

inline Vertex lattice_vertex(int n, int i, int j, int k) {
  return (i * (n + 1) + j) * (n + 1) + k;
}

// Triangles of tag 0 on all of the boundary.
inline void tag_boundary(TetMesh& mesh) {
  add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "test"), 0);
}

// `region` tells the region of a cube. No triangles: the boundary is found by assemble.
inline Lattice make_lattice(
    int n, const std::function<int(int, int, int)>& region = [](int, int, int) { return 1; }) {
  Lattice lattice{n, {}, {}};
  auto& [_, mesh, cubes] = lattice;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) mesh.points.push_back({1.0 * i, 1.0 * j, 1.0 * k});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        auto corner = [&](int a, int b, int c) { return lattice_vertex(n, i + a, j + b, k + c); };
        std::array<int, 3> order{0, 1, 2};
        do {
          std::array<int, 3> at{0, 0, 0};
          Tet tet{corner(0, 0, 0)};
          for (int step = 0; step < 3; ++step) {
            at[order[step]] = 1;
            tet[step + 1] = corner(at[0], at[1], at[2]);
          }
          if (tet_determinant(mesh.points, tet) < 0) std::swap(tet[2], tet[3]);
          cubes.tets.emplace_back(mesh.tets.size());
          mesh.tets.push_back(tet);
          mesh.tet_tags.push_back(region(i, j, k));
        } while (std::next_permutation(order.begin(), order.end()));
        cubes.vertices.push_back({corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0), corner(0, 0, 1),
                                  corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)});
        cubes.kind.push_back(CellKind::hex);
        cubes.quality.push_back(1);
        cubes.volume.push_back(1);
        cubes.tet_offsets.push_back(static_cast<std::int64_t>(cubes.tets.size()));
        cubes.boundary_tet_offsets.push_back(0);
      }
  return lattice;
}

// Moves inner vertices by at most `amount` along each axis.
inline void jitter(Lattice& lattice, double amount, Random& random) {
  const int n = lattice.n;
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j)
      for (int k = 1; k < n; ++k) {
        Vec3& at = lattice.mesh.points[lattice_vertex(n, i, j, k)];
        at += {random.uniform(-amount, amount), random.uniform(-amount, amount), random.uniform(-amount, amount)};
      }
}

inline std::vector<CandidateIndex> candidates_in(const IndependentSet& set) {
  return {set.begin(), set.end()};
}

inline IndependentSet random_choice(const Lattice& lattice, double share, Random& random) {
  IndependentSet chosen;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(lattice.cubes.size()); ++i)
    if (random.uniform() < share) chosen.push_back(i);
  return chosen;
}

}  // namespace hexpipe::testing
