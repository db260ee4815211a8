#pragma once
// Points of a lattice that bends with a surface's cross field. It passes through the points of the feature curves, so
// rows of points from opposite sides meet where they can.

#include <array>
#include <span>
#include <vector>

#include "tools/tetmesh/surface/cross_field.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {

struct SurfaceLattice {
  // The most trusted come first. A point of the lattice is in the list several times: each triangle near it proposes
  // it.
  std::vector<SurfacePoint> points;
  // For each triangle, the distance to the next point along each of its two directions, in sizes.
  std::vector<std::array<double, 2>> spacing;
  std::int64_t row_ends = 0;  // rows that end inside a face, not at a feature
};

// `kept` are the vertices of the surface that are points already. `opposite` says which sides face each other across
// the inside of the model: rows lead from one to the other. `row_stretch` is the most by which the distance between two
// neighbouring triangles of the field may change, in sizes, to join two rows that would end; 0 joins none.
SurfaceLattice surface_lattice(const FieldSurface& surface, const CrossField& field,
                               std::span<const OppositeSide> opposite, std::span<const Vertex> kept,
                               double row_stretch = 0);

}  // namespace hexpipe::tetmesh::surface
