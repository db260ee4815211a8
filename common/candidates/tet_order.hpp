#pragma once
// The tets of a mesh by their lowest vertex. A search goes from vertex to vertex: what it asks about the tets around
// one then lies near what it asked before, in whatever order the mesh had them.

#include <cstdint>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

// The numbers of the mesh's tets by lowest vertex, and ascending at each; none when that is how they stand.
std::vector<std::int32_t> order_by_lowest_vertex(const TetMesh& mesh);

}  // namespace hexpipe::candidates
