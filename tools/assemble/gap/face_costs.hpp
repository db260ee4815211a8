#pragma once
// The cost of faces in the objective (objective.hpp), where they join the centres of two cells badly.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/face_measures.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {

// A cell, present or planned, whose faces are judged.
struct FacesOf {
  CellKind kind = CellKind::tet;
  std::array<Vertex, 8> corners{};
  std::array<Vec3, 8> points{};
  bool is_kept = false;
};

// How cells that are judged together meet at their faces, and what lies behind the others: this stays while only their
// vertices move.
class FaceGraph {
 public:
  // As for cost_of_faces().
  FaceGraph(const GapMesh& gap, std::span<const FacesOf> cells, std::span<const GapIndex> instead_of);

  // Of all faces and cells.
  double cost(std::span<const FacesOf> cells) const;
  // What changes when these cells, ascending, do: the cost of their faces and of their spans.
  double cost_at(std::span<const FacesOf> cells, std::span<const std::size_t> changing) const;

 private:
  struct Face {
    std::size_t cell;
    std::uint8_t face;
    std::size_t other;  // another cell of the list, or `none`
    Vec3 beyond{};      // the centre behind, if `other` is none
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  template <class Counts>
  double cost_of_faces_that(std::span<const FacesOf> cells, Counts&& counts) const;

  const GapMesh* gap_;
  std::vector<Face> faces_;                         // those that cost something
  std::vector<std::array<std::uint8_t, 6>> inner_;  // by cell and face
};

// The cost of all faces of these cells, each face once; faces between two kept cells cost nothing. The cells stand in
// place of the gap's cells `instead_of`; on their other sides are the present cells of the mesh.
double cost_of_faces(const GapMesh& gap, std::span<const FacesOf> cells, std::span<const GapIndex> instead_of);
double cost_of_faces(const GapMesh& gap, std::span<const GapCell> cells, std::span<const GapIndex> instead_of);
// What a chosen cell costs because its faces do not span space well.
double cost_of_kept_span(const GapMesh& gap, KeptIndex c);
// Whether solvers would refuse a cell, or one of its faces, if `gap` is strict.
bool is_refused(const GapMesh& gap, GapIndex c);
// The cost of the faces of cells that are there, of one or more.
double cost_of_faces(const GapMesh& gap, GapIndex c);
double cost_of_faces(const GapMesh& gap, std::span<const GapIndex> cells);

}  // namespace hexpipe::assemble::gap
