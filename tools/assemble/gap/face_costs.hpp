#pragma once
// What the faces of cells cost in the objective (objective.hpp), for they join two centres badly.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/mesh/face_measures.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {

FaceShape shape_of(const GapMesh& gap, const Facet& facet);
Vec3 centre_of(const GapMesh& gap, const GapCell& cell);

// The centre of the cell that has the facet as it goes around it, of the gap or chosen, unless it is one of `without`;
// nothing on the boundary.
std::optional<Vec3> centre_behind(const GapMesh& gap, const Facet& facet, std::span<const std::int32_t> without);

// Of all faces of these cells, each once; `instead_of`: the cells in whose place they are, or would be.
double cost_of_faces(const GapMesh& gap, std::span<const GapCell> cells, std::span<const std::int32_t> instead_of);
// As it is.
double cost_of_faces(const GapMesh& gap, std::span<const std::int32_t> cells);

}  // namespace hexpipe::assemble::gap
