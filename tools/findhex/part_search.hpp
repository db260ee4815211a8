#pragma once
// The candidates that belong to a part of a mesh: docs/definitions.md 5.

#include "common/candidates/findhex.hpp"
#include "common/mesh/mesh_part.hpp"

namespace hexpipe::findhex {

// Those that begin at a point of the part's own, as they are found in the whole, in the part's numbers.
candidates::FindhexResult findhex_of_part(const TetMesh& mesh, const MeshPart& part,
                                          const candidates::FindhexOptions& options, const char* source);

}  // namespace hexpipe::findhex
