#pragma once
// A part of a mesh that was split so that each part fits a machine: which points and tets of the whole it has, and
// whose they are. docs/definitions.md 5 has the rules; formats/README.md the members of a bundle.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// Tells parts of one mesh from those of another.
struct MeshFingerprint {
  std::int64_t points = 0, tets = 0, triangles = 0;
  std::uint64_t checksum = 0;  // of all numbers and tags
  bool operator==(const MeshFingerprint&) const = default;
};

MeshFingerprint fingerprint_of(const TetMesh& mesh);

// Beside a TetMesh: the part's own tets and those around them (ghosts), in the order that they have in the whole.
struct MeshPart {
  std::int32_t part = 0, parts = 1;      // counted from 0
  std::vector<std::int32_t> neighbours;  // parts that may have candidates in conflict with this one's, ascending
  MeshFingerprint whole;
  // Numbers in the whole, ascending, and owners.
  std::vector<std::int64_t> point_number, tet_number, triangle_number;
  std::vector<std::int32_t> point_part, tet_part;
  // 1 for each tet whose last two corners have to be swapped (orientation.hpp), which only the whole tells; empty where
  // the whole has no negative tet.
  std::vector<std::int8_t> tet_turned;
};

// Throws DataError naming `source` when arrays disagree in length, numbers do not ascend or exceed the whole, or an
// owner is none of the parts.
void validate(const MeshPart& part, const char* source);

// Throws DataError naming `source` when there are not as many numbers as the mesh has points, tets and triangles; or as
// the candidates name points and tets.
void validate_against(const MeshPart& part, const TetMesh& mesh, const char* source);
void validate_against(const MeshPart& part, const Candidates& candidates, const char* source);

// "part 3 of 16", for messages.
std::string title_of(const MeshPart& part);

// By place in `from`, the place in `to` of the same number, or -1; both ascend.
std::vector<std::int32_t> places_in(const std::vector<std::int64_t>& to, const std::vector<std::int64_t>& from);

// What identifies candidates in all parts: ascending keys are the order that candidates have in a single run.
struct CandidateKeys {
  std::vector<std::uint64_t> key;
  std::vector<std::int32_t> part;  // owners
};
// Those of `kept`, in its order.
CandidateKeys select(const CandidateKeys& keys, std::span<const std::int32_t> kept);

// From the top: 2 bits for the kind, 38 for the number in the whole of the vertex that the candidate was found from, 24
// for its place among the candidates of this kind and vertex.
constexpr int key_place_bits = 24, key_vertex_bits = 38;

// Of all candidates that begin at points of the part's own, in the order in which they are found. Throws DataError
// naming `source` where a number does not fit.
CandidateKeys keys_of_own(const Candidates& candidates, const MeshPart& part, const char* source);

// Throws DataError naming `source` when there is not one for each of `count` candidates, or keys do not ascend.
void validate(const CandidateKeys& keys, std::size_t count, const char* source);

}  // namespace hexpipe
