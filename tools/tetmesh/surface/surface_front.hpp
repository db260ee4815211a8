#pragma once
// Points on a surface one size apart, in the directions of its cross field: first those of a lattice that fits the
// field, then points of a front between them, which starts from the feature curves.

#include <span>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/cross_field.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"
#include "tools/tetmesh/surface/surface_lattice.hpp"

namespace hexpipe::tetmesh::surface {

struct FrontPoints {
  std::vector<SurfacePoint> points;
  std::int64_t row_ends = 0;  // of the lattice, on faces
};

// `kept` holds the vertices of the surface that are points already: those of its feature curves. `rows` and `guide`:
// see surface_lattice.hpp.
FrontPoints surface_front(const CorrectedLinks& links, std::span<const Vertex> kept, const sizing::SizeField& size,
                          const RowOptions& rows, const RowGuide& guide);

}  // namespace hexpipe::tetmesh::surface
