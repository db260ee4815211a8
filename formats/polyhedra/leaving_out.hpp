#pragma once
// A flat cell at the boundary is left out: what it leaves is the boundary with an edge flipped, or without a vertex.

#include <optional>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

// What it is worth to leave out the cell, if that leaves the boundary as good as the same: the cell has two facets or
// more, all of one surface and with no sharp edge between them, those that come instead are nearly where they are and
// look the same way, and the boundary stays a manifold.
std::optional<Worth> worth_of_leaving_out(MeasuredMesh& mesh, std::int32_t cell);

// The facets of the cell go, and its other faces become facets of the same surface. False if the facets are not a disk.
bool leave_out(MeasuredMesh& mesh, std::int32_t cell);

}  // namespace hexpipe::polyhedra
