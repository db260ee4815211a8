#pragma once
// Puts vertices where tets are too flat for smoothing to help.

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::conform {

// Fills the cavity around every tet whose scaled Jacobian (times the square root of 2) is below `least` anew from a
// vertex inside, where that makes the worst tet better. Returns the number of vertices added.
std::int64_t repair_flat_tets(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, double least);

}  // namespace hexpipe::assemble::conform
