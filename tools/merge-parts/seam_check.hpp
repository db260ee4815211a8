#pragma once
// Checks that the pieces of a mesh fit together: at every facet where a piece ends, another piece ends too, or the
// facet is a tagged one of the boundary; and a point has the same place in all pieces.

#include <tsl/robin_map.h>

#include <array>
#include <cstdint>
#include <string>

#include "common/mesh/mesh_piece.hpp"
#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::merge_parts {

class SeamCheck {
 public:
  // Throws DataError naming `source` when a point has another place than in earlier pieces, or a facet is in a third
  // piece.
  void add(const MixedMesh& mesh, const MeshPiece& piece, const std::string& source);
  // Call it after the last piece. Throws DataError when a facet is in one piece only and not tagged.
  void end() const;

 private:
  // The points of a facet by their numbers in the whole: the lowest, the one opposite to it (no_index in a triangle),
  // and the other two ascending.
  using Facet = std::array<std::int64_t, 4>;
  struct Hash {
    std::size_t operator()(const Facet& facet) const;
  };
  struct Sides {
    std::int32_t pieces = 0;
    std::int32_t first = 0;
    bool tagged = false;
  };
  static Facet facet_of(const MeshPiece& piece, const Vertex* corners, std::size_t count);

  tsl::robin_map<Facet, Sides, Hash> facets_;
  tsl::robin_map<std::int64_t, Vec3> places_;  // of points of these facets
};

}  // namespace hexpipe::merge_parts
