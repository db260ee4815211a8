#pragma once
// What the faces of cells cost in the objective (objective.hpp), for they join two centres badly.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/face_measures.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {

// A cell as it is, or would be.
struct FacesOf {
  CellKind kind = CellKind::tet;
  std::array<Vertex, 8> corners{};
  std::array<Vec3, 8> points{};
  bool is_kept = false;
};

// Of all faces of these cells, each once, but those between two that are kept; `instead_of`: the cells of the gap in
// whose place they are. Beyond them is what the mesh has there.
double cost_of_faces(const GapMesh& gap, std::span<const FacesOf> cells, std::span<const std::int32_t> instead_of);
double cost_of_faces(const GapMesh& gap, std::span<const GapCell> cells, std::span<const std::int32_t> instead_of);
// As it is.
double cost_of_faces(const GapMesh& gap, std::span<const std::int32_t> cells);

}  // namespace hexpipe::assemble::gap
