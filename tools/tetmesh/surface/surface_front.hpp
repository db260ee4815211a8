#pragma once
// Points on a surface in the directions of its cross field, a size apart: those of a lattice that fits it, and between
// them by a front that starts from the feature curves.

#include <span>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/cross_field.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {

struct FrontPoints {
  std::vector<SurfacePoint> points;
  std::int64_t row_ends = 0;  // of the lattice, on faces
};

// `kept` are the vertices of the surface that are points already: those of its feature curves. `row_stretch`:
// see surface_lattice.hpp.
FrontPoints surface_front(const FieldSurface& surface, const CrossField& field, std::span<const OppositeSide> opposite,
                          std::span<const Vertex> kept, const sizing::SizeField& size, double row_stretch);

}  // namespace hexpipe::tetmesh::surface
