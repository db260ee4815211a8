#pragma once
// A part of a mesh that was split so that each part fits on a machine: which points and tets of the whole mesh it has,
// and which part owns them. docs/definitions.md 5 has the rules; formats/README.md describes the members of a bundle.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// Distinguishes the parts of one mesh from those of another.
struct MeshFingerprint {
  std::int64_t points = 0, tets = 0, triangles = 0;
  std::uint64_t checksum = 0;  // over all numbers and tags
  bool operator==(const MeshFingerprint&) const = default;
};

MeshFingerprint fingerprint_of(const TetMesh& mesh);

// Accompanies a TetMesh that holds the part's own tets and those around them (ghosts), in the order of the whole mesh.
struct MeshPart {
  std::int32_t part = 0, parts = 1;      // counted from 0
  std::vector<std::int32_t> neighbours;  // parts whose candidates may conflict with this one's, ascending
  MeshFingerprint whole;
  // Numbers in the whole mesh, ascending, and owners.
  std::vector<std::int64_t> point_number, tet_number, triangle_number;
  std::vector<std::int32_t> point_part, tet_part;
  // 1 for each tet whose last two corners have to be swapped (orientation.hpp); only the whole mesh shows which. Empty
  // if the whole mesh has no negative tet.
  std::vector<std::int8_t> tet_turned;
};

// Throws DataError naming `source` when arrays disagree in length, numbers do not ascend or are not in the whole mesh,
// or an owner is not one of the parts.
void validate(const MeshPart& part, const char* source);

// Throws DataError naming `source` when the numbers do not match the points, tets and triangles of the mesh, or the
// points and tets that the candidates name.
void validate_against(const MeshPart& part, const TetMesh& mesh, const char* source);
void validate_against(const MeshPart& part, const Candidates& candidates, const char* source);

// "part 3 of 16", for messages.
std::string title_of(const MeshPart& part);

// For each place in `from`, the place in `to` that has the same number, or no_index. Both ascend.
template <class Place = std::int32_t>
std::vector<Place> places_in(const std::vector<std::int64_t>& to, const std::vector<std::int64_t>& from) {
  std::vector<Place> places(from.size(), no_index);
  std::size_t at = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    while (at < to.size() && to[at] < from[i]) ++at;
    if (at < to.size() && to[at] == from[i]) places[i] = static_cast<Place>(at);
  }
  return places;
}

// Identifies candidates across all parts. Ascending keys give the order in which a single run has the candidates.
struct CandidateKeys {
  std::vector<std::uint64_t> key;
  std::vector<std::int32_t> part;  // owners
};
// The keys named by `kept`, in its order.
CandidateKeys select(const CandidateKeys& keys, std::span<const CandidateIndex> kept);

// A key holds, from the top: 2 bits for the kind; 38 bits for the vertex where the candidate was found, as numbered in
// the whole mesh; 24 bits for its place among the candidates of this kind and vertex.
constexpr int key_place_bits = 24, key_vertex_bits = 38;

// The keys of all candidates that begin at the part's own points, in the order in which they are found. Throws
// DataError naming `source` when a number does not fit.
CandidateKeys keys_of_own(const Candidates& candidates, const MeshPart& part, const char* source);

// Throws DataError naming `source` when there is not one key for each of `count` candidates, or keys do not ascend.
void validate(const CandidateKeys& keys, std::size_t count, const char* source);

}  // namespace hexpipe
