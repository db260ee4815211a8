#pragma once
// Whole numbers of steps for all feature curves together, with which no row of points has to end on a face.

#include <span>
#include <vector>

#include "tools/tetmesh/surface/feature_curves.hpp"
#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// For each half-edge of a feature, the curve that it is on; no_index elsewhere. Where sheets meet in a curve, those of
// all sheets are.
using CurveOfHalfEdge = std::vector<std::int32_t>;

struct CurveDemand {
  double steps = 0;   // wanted: those of the rows that begin there
  double sizes = 0;   // its length in sizes
  double length = 0;  // the sum of its edges' lengths
  bool closed = false;
};

// As near to the wanted numbers as the faces allow: around a face on which the field has no singularity, the numbers of
// steps add up to zero along both of its directions; around others they are even, so that singularities can take up
// what is left. Faces that would press or stretch a curve's steps too much are left out, and rows end there.
std::vector<int> plan_steps(const SurfaceLinks& links, std::span<const CurveDemand> curves,
                            const CurveOfHalfEdge& curve_of);

}  // namespace hexpipe::tetmesh::surface
