#pragma once
// Gives a mesh nodes of second order, and tells where they lie.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::curved {

// Adds a node in the middle of each edge and, if `full`, of each quad and each hex, behind the mesh's points. All edges
// are straight. Throws DataError if there are more points than can be numbered.
void add_straight_nodes(MixedMesh& mesh, bool full);

// Where the middle of a quad lies whose edges have these nodes, as elements without a node there have it. To the bit
// the same from whichever corner and side one lists it, so that it is one place for the cells on both sides.
Vec3 middle_of_quad(const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& edges);

// The middle of a hex between its sides. `corners`, `edges` and `quads` are all that it has.
Vec3 middle_of_hex(std::span<const Vec3> corners, std::span<const Vec3> edges, std::span<const Vec3> quads);

// The place of the edge of two corners in the list; it has to be there.
std::size_t edge_between(std::span<const LocalEdge> edges, std::uint8_t a, std::uint8_t b);

}  // namespace hexpipe::curved
