#pragma once
// Meshes and helpers for the tests of the formats.

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "common/run/error.hpp"
#include "common/run/random.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "tests/unit/written_bytes.hpp"

namespace hexpipe {
using namespace formats;

// A cube with a prism on its top, a pyramid on its right and a tet between these two; conforming, every cell valid.
// Each cell is a region of its own. Some facets are on the boundary, and one lies between hex and pyramid.
inline MixedMesh one_cell_of_each_kind() {
  MixedMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},     {0, 1, 0},   {0, 0, 1},    {1, 0, 1},
                 {1, 1, 1}, {0, 1, 1}, {2, 0.5, 0.5}, {0, 0.5, 2}, {1, 0.5, 2.1}};
  mesh.hexes = {{{0, 1, 2, 3, 4, 5, 6, 7}}, {1}, {1.0}};
  mesh.prisms = {{{4, 7, 9, 5, 6, 10}}, {2}, {0.75}};
  mesh.pyramids = {{{1, 2, 6, 5, 8}}, {3}, {0.1}};
  mesh.tets = {{{6, 5, 8, 10}}, {4}, {1.0 / 3}};
  mesh.triangles = {{{4, 9, 7}, {5, 8, 10}, {1, 2, 8}}, {30, 10, 20}, {}};
  mesh.quads = {{{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}}, {10, 20, 7}, {}};
  return mesh;
}

inline double random_coordinate(Random& random) {
  // All magnitudes, and often few digits.
  if (random.below(4) == 0) return static_cast<double>(random.below(10)) - 5;
  return random.uniform(-1, 1) * std::pow(10.0, random.uniform(-20, 20));
}

inline std::int32_t random_tag(Random& random) {
  switch (random.below(8)) {
    case 0:
      return 0;
    case 1:
      return -static_cast<std::int32_t>(random.below(3));
    case 2:
      return static_cast<std::int32_t>(random.next());
    default:
      return static_cast<std::int32_t>(random.below(6));
  }
}

// Cells with random vertices and tags: what is written and read, not what is geometry.
inline MixedMesh random_mesh(std::uint64_t seed) {
  Random random(seed);
  MixedMesh mesh;
  mesh.points.resize(8 + random.below(30));
  for (Vec3& p : mesh.points) p = {random_coordinate(random), random_coordinate(random), random_coordinate(random)};
  const bool with_quality = random.below(2) == 0;
  for_each_block(mesh, [&](const ElementNames& names, auto& block) {
    block.cells.resize(random.below(4) == 0 ? 0 : random.below(12));
    for (auto& cell : block.cells) {
      std::set<Vertex> used;
      for (Vertex& v : cell) {
        do v = static_cast<Vertex>(random.below(mesh.points.size()));
        while (!used.insert(v).second);
      }
      block.tags.push_back(random_tag(random));
      if (with_quality && names.dimension == 3) block.quality.push_back(random.uniform(-1, 1));
    }
  });
  return mesh;
}

inline void drop_quality(MixedMesh& mesh) {
  for_each_block(mesh, [](const ElementNames&, auto& block) { block.quality.clear(); });
}

inline std::string written(const MixedMesh& mesh, std::string_view format) {
  return hexpipe::testing::written_bytes([&](Output& output) { write_mixed_mesh(mesh, format, output); });
}

inline MixedMesh parsed(std::string bytes) {
  Input input = Input::from_memory(std::move(bytes), "test");
  return read_mixed_mesh(input);
}

// The message of the error that reading throws; empty when it throws none.
inline std::string message_of_reading(std::string bytes) {
  try {
    parsed(std::move(bytes));
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

}  // namespace hexpipe
