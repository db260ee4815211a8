#pragma once
// Points of a lattice that bends with a surface's cross field. It passes through the points of the feature curves, so
// rows of points from opposite sides meet where they can.

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "tools/tetmesh/fields/periodic_numbers.hpp"
#include "tools/tetmesh/surface/cross_field.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"
#include "tools/tetmesh/surface/links_across.hpp"
#include "tools/tetmesh/surface/opposite_sides.hpp"
#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// A lattice that is known already (that of the volume), where it meets the surface.
struct RowGuide {
  // The coordinates of a place along two directions at right angles to the normal, as exp(2 pi i coordinate) times how
  // certain they are, from 0 to 1. Nothing: there is no guide.
  std::function<std::array<fields::Complex, 2>(const Vec3& place, const Vec3& normal,
                                               const std::array<Vec3, 2>& directions)>
      coordinates;
  // Its points near the surface, the most trusted first.
  std::vector<Vec3> points;
};

struct SurfaceLattice {
  // The most trusted come first. A point of the lattice is in the list several times: each triangle near it proposes
  // it.
  std::vector<SurfacePoint> points;
  // For each triangle, the distance to the next point along each of its two directions, in sizes.
  std::vector<std::array<double, 2>> spacing;
  std::int64_t row_ends = 0;  // rows that end inside a face, not at a feature
};

// How the triangles of a surface see others along a field, and across the inside of the model where sides face each
// other: rows lead from one to the other. Distances add up (surface_curl.hpp). `kept` are the vertices of the surface
// that are points already. Lattices on the same surface, field and vertices have these in common, with or without a
// guide.
struct CorrectedLinks {
  CorrectedLinks(const FieldSurface& surface, const CrossField& field, std::span<const OppositeSide> opposite,
                 std::span<const Vertex> kept);

  SurfaceLinks links;
  LinksAcross across;
};

struct RowOptions {
  // The most by which the distance between two neighbouring triangles of the field may change, in sizes, to join two
  // rows that would end; 0 joins none.
  double stretch = 0;
  // Without a guide: whole numbers of rows lie between features that stand apart (fields/whole_rows.hpp).
  bool are_whole = true;
};

// `kept` are those of the links. With a guide, the lattice is that of the guide wherever it is certain.
SurfaceLattice surface_lattice(const CorrectedLinks& known, std::span<const Vertex> kept, const RowOptions& rows,
                               const RowGuide& guide);

}  // namespace hexpipe::tetmesh::surface
