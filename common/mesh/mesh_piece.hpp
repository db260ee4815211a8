#pragma once
// A piece of a result: what assemble made of one part of a mesh, and how it fits to the other pieces.
// docs/definitions.md 5 has the rules; formats/README.md the members of a bundle.

#include <cstdint>
#include <string>
#include <vector>

#include "common/mesh/mesh_part.hpp"
#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe {

struct MeshPiece {
  std::int32_t part = 0, parts = 1;  // counted from 0
  MeshFingerprint whole;
  // Whether another round, with what all pieces say here, would find nothing new to say.
  bool settled = false;
  // Of each point of the result: its number in the whole mesh, or one from there on that no other point has.
  std::vector<std::int64_t> point_number;
  // Tets that are at home in this part, but belong to the piece of another, by number in the whole, ascending.
  std::vector<std::int64_t> moved_tets;
  std::vector<std::int32_t> moved_to;
  // Keys of chosen candidates, of this part or another, that went back to their tets, ascending.
  std::vector<std::uint64_t> given_back;
};

// Throws DataError naming `source` when arrays disagree in length, do not ascend or exceed the whole.
void validate(const MeshPiece& piece, const char* source);
// Throws DataError naming `source` when there is not one number for each point.
void validate_against(const MeshPiece& piece, const MixedMesh& mesh, const char* source);

}  // namespace hexpipe
