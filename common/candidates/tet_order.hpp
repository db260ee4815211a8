#pragma once
// Sorts the tets of a mesh by their lowest vertex. A search goes from vertex to vertex, so the tets that it asks about
// are then close in memory to those before, whatever order the mesh had.

#include <cstdint>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

// The numbers of the mesh's tets by lowest vertex, ascending at each vertex; empty if they are already in this order.
std::vector<std::int32_t> order_by_lowest_vertex(const TetMesh& mesh);

}  // namespace hexpipe::candidates
