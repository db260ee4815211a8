#pragma once
// Merges vertices on the surface that no chosen cell uses into neighbours along it.

#include <cstdint>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::gap {

// A vertex within a smooth part of the surface goes to any neighbour on it, one on a curve to the next on the curve,
// while the objective falls and the surface stays as near to the input's as most_deviation_at() says; returns how many
// are gone. Corners stay, and vertices where more than one sheet ends. `tags`, those of `gap`, follow. `gap` has to be
// valid, and stays so.
std::int64_t merge_on_surface(GapMesh& gap, hybrid::SurfaceTags& tags, const shape::InputSurface& surface);

}  // namespace hexpipe::assemble::gap
