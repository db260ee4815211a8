#pragma once
// How dense the points on feature curves have to be so that the rows of a lattice that begin there reach the other
// curves, where the same number of rows should begin.

#include <optional>
#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_curves.hpp"

namespace hexpipe::tetmesh::surface {

// The rows follow the surface's cross field, on triangles as refine_surface() makes them with the last two lengths.
// Where the surface bends evenly, they lie closer (bend_stretch.hpp) by `chord_height`.
std::vector<MeasuredCurve> curves_by_rows(const FeatureMesh& mesh, const sizing::SizeField& size,
                                          const std::optional<sizing::SizeField>& chord_height,
                                          const sizing::SizeField& longest, const sizing::SizeField& flatness);

}  // namespace hexpipe::tetmesh::surface
