#pragma once
// A mesh of any polyhedra: faces with any number of corners, each between two cells or on the boundary.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::polyhedra {

struct PolyhedralMesh {
  struct Face {
    std::size_t begin = 0;  // its corners in `corners`, counter-clockwise as seen from outside its owner
    std::int32_t count = 0;
    std::int32_t owner = no_index;  // none: the face is gone
    std::int32_t neighbour = no_index;
    std::int32_t surface = no_index;  // the place of its name in a list
    bool flipped = false;             // whether the facet of its surface looks against it

    bool is_inner() const { return neighbour != no_index; }
    std::int32_t other_cell(std::int32_t cell) const { return cell == owner ? neighbour : owner; }
  };

  std::vector<Vec3> points;
  std::vector<Vertex> corners;
  std::vector<Face> faces;
  // By cell: its region, as the place of its name in a list; and whether it is a hex.
  std::vector<std::int32_t> regions;
  std::vector<std::uint8_t> is_hex;

  std::span<const Vertex> corners_of(const Face& face) const {
    return std::span(corners).subspan(face.begin, static_cast<std::size_t>(face.count));
  }
  // The face has its corners, owner and neighbour alone. Returns its number.
  std::int32_t add_face(std::span<const Vertex> loop, std::int32_t owner, std::int32_t neighbour);
};

// Leaves out faces and points that are gone, and numbers cells by `order`, which has a place for each cell that stays
// and no_index for the others. The owner of a face is the lower of its cells afterwards.
void renumber(PolyhedralMesh& mesh, std::span<const std::int32_t> order);

}  // namespace hexpipe::polyhedra
