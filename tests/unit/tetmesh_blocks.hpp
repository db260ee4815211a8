#pragma once
// Blocks of cubes, each cut into six tets around one diagonal, and the nodes of a field on their vertices.

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/volume/field_nodes.hpp"

namespace hexpipe::testing {

using Place = std::array<std::int32_t, 3>;

// From 0 to `last`, both included, x first.
inline std::vector<Place> places_up_to(const Place& last) {
  std::vector<Place> places;
  for (std::int32_t z = 0; z <= last[2]; ++z)
    for (std::int32_t y = 0; y <= last[1]; ++y)
      for (std::int32_t x = 0; x <= last[0]; ++x) places.push_back({x, y, z});
  return places;
}

// So many cubes along each axis, of side 1, in region 0. number(place) tells which vertex is where; vertices have their
// points already.
template <class Number>
void fill_with_cubes(const Place& cubes, Number&& number, TetMesh& mesh) {
  for (const Place& place : places_up_to({cubes[0] - 1, cubes[1] - 1, cubes[2] - 1})) {
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      Place at = place;
      Tet tet{number(at)};
      for (std::size_t i = 0; i < 3; ++i) {
        ++at[order[i]];
        tet[i + 1] = number(at);
      }
      if (tet_determinant(mesh.points, tet) < 0) std::swap(tet[2], tet[3]);
      mesh.tets.push_back(tet);
      mesh.tet_tags.push_back(0);
    } while (std::ranges::next_permutation(order).found);
  }
}

// Of size 1, with links of one weight to all neighbours. They know nothing of a surface.
inline tetmesh::volume::FieldNodes nodes_on(const TetMesh& mesh, const TetAdjacency& adjacency) {
  tetmesh::volume::FieldNodes nodes;
  nodes.points = mesh.points;
  nodes.sizes.assign(mesh.points.size(), 1);
  nodes.offsets.assign(1, 0);
  for (Vertex v = 0; v < static_cast<Vertex>(mesh.points.size()); ++v) {
    for (const Vertex u : adjacency.neighbours_of(v)) nodes.links.push_back({u, 1});
    nodes.offsets.push_back(static_cast<std::int64_t>(nodes.links.size()));
  }
  return nodes;
}

}  // namespace hexpipe::testing
