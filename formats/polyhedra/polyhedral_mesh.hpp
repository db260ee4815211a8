#pragma once
// A mesh of any polyhedra: faces with any number of corners, each between two cells or on the boundary.

#include <cstdint>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::polyhedra {

// The edges of a closed loop of vertices, each as a pair (from, to), the last one back to the first vertex. A view: the
// loop has to outlive it.
inline auto edges_of(std::span<const Vertex> loop) {
  return std::views::iota(std::size_t{0}, loop.size()) | std::views::transform([loop](std::size_t i) {
           return std::pair(loop[i], loop[i + 1 < loop.size() ? i + 1 : 0]);
         });
}
auto edges_of(std::vector<Vertex>&& loop) = delete;

struct PolyhedralMesh {
  struct Face {
    std::size_t begin = 0;  // its corners in `corners`, counter-clockwise as seen from outside its owner
    std::int32_t count = 0;
    std::int32_t owner = no_index;      // no_index: the face has been removed
    std::int32_t neighbour = no_index;  // no_index: the face is a facet of the boundary
    std::int32_t surface = no_index;    // an index into the writer's list of names; no_index: it has no tag
    bool flipped = false;               // whether the surface's own normal points into the owner

    bool is_inner() const { return neighbour != no_index; }
    std::int32_t other_cell(std::int32_t cell) const { return cell == owner ? neighbour : owner; }
  };

  std::vector<Vec3> points;
  std::vector<Vertex> corners;
  std::vector<Face> faces;
  // By cell: its region, as an index into the writer's list of names; and whether it is a hex.
  std::vector<std::int32_t> regions;
  std::vector<std::uint8_t> is_hex;

  std::span<const Vertex> corners_of(const Face& face) const {
    return std::span(corners).subspan(face.begin, static_cast<std::size_t>(face.count));
  }
  // Adds a face on no surface. `loop` is counter-clockwise as seen from outside the owner. Returns the face's number.
  std::int32_t add_face(std::span<const Vertex> loop, std::int32_t owner, std::int32_t neighbour);
};

// Drops removed faces and unused points, and gives cells their numbers in `order`: one for each cell that stays, and
// no_index for the others. Afterwards the owner of a face is the cell with the lower number, as OpenFOAM wants it.
void renumber(PolyhedralMesh& mesh, std::span<const std::int32_t> order);

}  // namespace hexpipe::polyhedra
