#pragma once
// A flat cell at the boundary is left out. The boundary is then the same but for a flipped edge or a vertex less.

#include <optional>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

// What it costs to leave out the cell; nullopt if that would change the boundary by more than a little. The cell must
// not be a hex and must have two facets or more, all of one surface and with no sharp edge between them. The faces that
// become facets must be near them and turned the same way, and the boundary must stay a manifold.
std::optional<Cost> cost_of_leaving_out(MeasuredMesh& mesh, std::int32_t cell);

// Removes the cell and its facets; its other faces become facets of the same surface. False, and nothing is changed, if
// the facets or the other faces are not a disk.
bool leave_out(MeasuredMesh& mesh, std::int32_t cell);

}  // namespace hexpipe::polyhedra
