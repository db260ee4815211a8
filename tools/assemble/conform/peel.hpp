#pragma once
// Takes tets off the boundary that are so flat that they lie on it.

#include <cstdint>
#include <span>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::conform {

// Takes off every tet whose least scaled Jacobian (times the square root of 2) is below `least`, with two facets on a
// smooth part of the boundary, that is as near to the input's surface as most_deviation_at() says: its other two facets
// are boundary in their place. Those with an edge between shared vertices of the input (seam.hpp;
// empty where there are none) stay. Returns their number.
std::int64_t peel_flat_tets(hybrid::HybridMesh& mesh, hybrid::SurfaceTags& tags, const shape::InputSurface& surface,
                            std::span<const std::uint8_t> is_shared, double least);

}  // namespace hexpipe::assemble::conform
