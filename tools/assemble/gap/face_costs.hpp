#pragma once
// The cost of faces in the objective (objective.hpp), where they join the centres of two cells badly.

#include <array>
#include <cstdint>
#include <optional>
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
  std::optional<Vec3> centre{};  // where it is known
};

// The cost of all faces of these cells, each face once; faces between two kept cells cost nothing. The cells stand in
// place of the gap's cells `instead_of`; on their other sides are the present cells of the mesh.
double cost_of_faces(const GapMesh& gap, std::span<const FacesOf> cells, std::span<const GapIndex> instead_of);
double cost_of_faces(const GapMesh& gap, std::span<const GapCell> cells, std::span<const GapIndex> instead_of);
// The cost of the faces of cells that are there, of one or more.
double cost_of_faces(const GapMesh& gap, GapIndex c);
double cost_of_faces(const GapMesh& gap, std::span<const GapIndex> cells);

}  // namespace hexpipe::assemble::gap
