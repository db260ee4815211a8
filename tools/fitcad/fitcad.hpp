#pragma once
// From a result near the CAD to one whose boundary's vertices lie on it.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/fitcad/cad_shape.hpp"
#include "tools/fitcad/move_boundary.hpp"

namespace hexpipe::fitcad {

struct FitcadOptions {
  double reach = 0.25;  // how far a vertex may be from its place, in lengths of the edges there
};

// Distances in the units of the mesh.
struct BoundaryDistances {
  double vertices = 0;  // the greatest from a vertex of the boundary to its place on the CAD
  double to_cad = 0;    // from the middles of facets and of their edges to the CAD
  double from_cad = 0;  // from points of the CAD's faces to the nearest facet
};

// The figures of one kind of cells.
struct KindQuality {
  CellKind kind;
  std::int64_t count = 0;
  double volume = 0;
  double least = 0, mean = 0;  // of the least scaled Jacobian over a cell's corners
};

struct FitcadResult {
  MoveCounts counts;
  std::int64_t boundary = 0, on_curves = 0, on_corners = 0;  // vertices
  std::int64_t strays = 0;                                   // too far from the CAD, so left where they are
  std::array<KindQuality, 4> cells{};
  BoundaryDistances before, after;
  double diagonal = 0;  // of the CAD
};

FitcadResult fit_to_cad(MixedMesh& mesh, const CadShape& shape, const FitcadOptions& options);

nlohmann::ordered_json to_json(const FitcadResult& result);

}  // namespace hexpipe::fitcad
