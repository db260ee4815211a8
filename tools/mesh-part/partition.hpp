#pragma once
// Divides the tets and the points of a mesh among parts.

#include <cstdint>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::mesh_part {

struct Partition {
  std::vector<std::int32_t> tet_part, point_part;
};

// Makes `parts` parts of about the same number of tets, none without a tet. A point belongs to the part that has most
// of its tets, to the first of several such parts, and to part 0 if it has no tets. The same seed gives the same
// partition. Throws DataError naming `source` when there are fewer tets than parts, or more than METIS can count.
Partition partition(const TetMesh& mesh, const TetAdjacency& adjacency, std::int32_t parts, std::uint64_t seed,
                    const char* source);

}  // namespace hexpipe::mesh_part
