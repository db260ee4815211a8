#pragma once
// Finds the candidates that belong to a part of a mesh: docs/definitions.md 5.

#include "common/candidates/findhex.hpp"
#include "common/mesh/mesh_part.hpp"

namespace hexpipe::findhex {

// The candidates that begin at one of the part's own points. They are the same as in the whole mesh, in the part's
// numbers.
candidates::FindhexResult findhex_of_part(const TetMesh& mesh, const MeshPart& part,
                                          const candidates::FindhexOptions& options, const char* source);

}  // namespace hexpipe::findhex
