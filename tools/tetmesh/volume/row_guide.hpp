#pragma once
// Where the lattice of a volume has its points on the surface, for a surface whose points follow it.

#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/surface_lattice.hpp"
#include "tools/tetmesh/volume/lattice_field.hpp"

namespace hexpipe::tetmesh::volume {

using CoordinatesOnSurface = decltype(surface::RowGuide::coordinates);

// All arguments must outlive the result.
CoordinatesOnSurface coordinates_on_surface(const FieldNodes& nodes, const std::vector<fields::Frame>& frames,
                                            const LatticeField& lattice, const sizing::SizeField& size);

}  // namespace hexpipe::tetmesh::volume
