#pragma once
// Points of a lattice that bends with a surface's cross field and passes through the points of its feature curves, so
// that rows from opposite sides meet where that is possible.

#include <array>
#include <span>
#include <vector>

#include "tools/tetmesh/surface/cross_field.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {

struct SurfaceLattice {
  // Those that come first are trusted most; the same point of the lattice comes several times, as it is seen from
  // several triangles.
  std::vector<SurfacePoint> points;
  // How far the next points are in each triangle, along both of its directions, in sizes.
  std::vector<std::array<double, 2>> spacing;
  std::int64_t row_ends = 0;  // on faces
};

// `kept` are the vertices of the surface that are points already. Of sides that face each other across the inside, so
// that rows lead from the one to the other, `opposite` tells.
// `row_stretch`: by how much the distance from one triangle of the field to the next may change, in sizes, for rows not
// to end; 0: rows are never joined.
SurfaceLattice surface_lattice(const FieldSurface& surface, const CrossField& field,
                               std::span<const OppositeSide> opposite, std::span<const Vertex> kept,
                               double row_stretch = 0);

}  // namespace hexpipe::tetmesh::surface
