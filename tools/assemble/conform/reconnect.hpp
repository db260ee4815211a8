#pragma once
// Better tets on the same vertices: the tets around an edge, or on both sides of a facet, are exchanged for others.

#include <cstdint>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::conform {

// For every tet whose least scaled Jacobian (times the square root of 2) is below `least`: makes the exchange that
// leaves the worst tet of those taking part best, where it becomes better at all; goes on with the new tets. Cells,
// tagged facets and regions stay as they are. Returns the number of exchanges.
std::int64_t reconnect_poor_tets(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, double least);

}  // namespace hexpipe::assemble::conform
