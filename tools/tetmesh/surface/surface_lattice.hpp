#pragma once
// Points of a lattice that bends with a surface's cross field and passes through the points of its feature curves, so
// that rows from opposite sides meet where that is possible.

#include <span>

#include "tools/tetmesh/surface/cross_field.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe {

// `kept` are the vertices of the surface that are points already. Those that come first are trusted most; the same
// point of the lattice comes several times, as it is seen from several triangles.
std::vector<SurfacePoint> surface_lattice(const FieldSurface& surface, const CrossField& field,
                                          std::span<const Vertex> kept, const SizeField& size);

}  // namespace hexpipe
