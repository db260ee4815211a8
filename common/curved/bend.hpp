#pragma once
// Bends a mesh of second order: nodes of the boundary go to their places on the surface, those inside follow, and where
// a cell would not be valid, nodes go back towards the chord.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::curved {

// A node of an edge or of a quad on the boundary, and its place.
struct Target {
  Vertex node;
  Vec3 at;
};

struct BendCounts {
  std::int64_t on_boundary = 0;      // nodes on facets
  std::int64_t curved_cells = 0;     // cells that have a bent edge or side
  std::int64_t invalid = 0;          // cells that were not valid, or hardly, before nodes went back
  std::vector<Vertex> drawn_back{};  // nodes of the boundary that are not in their places, in ascending order
  std::int64_t straight = 0;         // of these: nodes that are on the chord
  double farthest = 0;               // from such a node to its place
};

// The least share of the straight cell's Jacobian that the bent one has everywhere.
inline constexpr double kept_share = 0.1;

// Targets of nodes that are not on facets have no effect. The Jacobian of each cell is shown to be positive everywhere
// (curved_validity.hpp); a cell that is straight is as valid as it was.
BendCounts bend(MixedMesh& mesh, std::span<const Target> targets);

}  // namespace hexpipe::curved
