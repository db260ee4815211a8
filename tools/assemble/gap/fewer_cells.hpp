#pragma once
// Makes the cells between the hexes fewer and better, without a change to any hex.

#include <cstdint>
#include <span>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::gap {

struct FewerCells {
  std::int64_t merged = 0;      // vertices that no hex uses, into others
  std::int64_t on_surface = 0;  // of these, along the surface
  std::int64_t refilled = 0;    // rooms

  bool any() const { return merged + refilled > 0; }
  FewerCells& operator+=(const FewerCells& more) {
    merged += more.merged, on_surface += more.on_surface, refilled += more.refilled;
    return *this;
  }
};

// The surface along which vertices may merge, as it is by now and as it was.
struct Surface {
  hybrid::SurfaceTags& tags;
  const shape::InputSurface& input;
};

// Lowers the objective (objective.hpp). The mesh has to conform; nothing is done where a tet, or a cell made of tets,
// is not valid. Vertices of cells that were chosen and shared ones stay where they are, those on tagged facets on
// these. `quickly`: only merges into neighbours, for a mesh whose vertices have not been smoothed yet.
FewerCells make_fewer_cells(hybrid::HybridMesh& mesh, const Surface& surface, std::span<const std::uint8_t> is_shared,
                            bool quickly);

}  // namespace hexpipe::assemble::gap
