#pragma once
// A piece of a result: the mesh that assemble made of one part, and how it fits to the other pieces.
// docs/definitions.md 5 has the rules; formats/README.md describes the members of a bundle.

#include <cstdint>
#include <string>
#include <vector>

#include "common/mesh/mesh_part.hpp"
#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe {

struct MeshPiece {
  std::int32_t part = 0, parts = 1;  // counted from 0
  MeshFingerprint whole;
  // Whether another round, given what all pieces report here, would find nothing new to report.
  bool settled = false;
  // For each point of the result: its number in the whole mesh, or a larger number that no other point has.
  std::vector<std::int64_t> point_number;
  // Tets that this part owns but that belong to another part's piece: their numbers in the whole mesh, ascending.
  std::vector<std::int64_t> moved_tets;
  std::vector<std::int32_t> moved_to;
  // Keys of chosen candidates, of this part or another, that were replaced by their tets; ascending.
  std::vector<std::uint64_t> given_back;
};

// Throws DataError naming `source` when arrays disagree in length, do not ascend or are not in the whole mesh.
void validate(const MeshPiece& piece, const char* source);
// Throws DataError naming `source` when there is not one number per point.
void validate_against(const MeshPiece& piece, const MixedMesh& mesh, const char* source);

}  // namespace hexpipe
