#pragma once
// A scene for the tests of viewmesh: a lattice of unit hexes.

#include "tools/viewmesh/make_scene.hpp"

namespace hexpipe {

// n x n x n unit hexes.
inline pipeline::StageData hex_lattice(int n) {
  MixedMesh mesh;
  const auto point = [&](int x, int y, int z) { return x + (n + 1) * (y + (n + 1) * z); };
  for (int z = 0; z <= n; ++z)
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) mesh.points.push_back({1.0 * x, 1.0 * y, 1.0 * z});
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        mesh.hexes.cells.push_back({point(x, y, z), point(x + 1, y, z), point(x + 1, y + 1, z), point(x, y + 1, z),
                                    point(x, y, z + 1), point(x + 1, y, z + 1), point(x + 1, y + 1, z + 1),
                                    point(x, y + 1, z + 1)});
        mesh.hexes.tags.push_back(x);
      }
  pipeline::StageData data;
  data.result = mesh;
  return data;
}

inline viewmesh::Scene lattice_scene(int n) {
  return viewmesh::make_scene(hex_lattice(n), viewmesh::Scene::Content::result, "test");
}

}  // namespace hexpipe
