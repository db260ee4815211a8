#pragma once
// Moves the boundary of a result onto the CAD that it was made from, and measures how far it is off before and after.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/fitcad/cad_shape.hpp"
#include "tools/fitcad/move_boundary.hpp"

namespace hexpipe::fitcad {

struct FitcadOptions {
  double reach = 0.25;  // how far a vertex may be from its place, by the mean length of the edges of its facets
};

// The greatest distances, in the unit of the mesh.
struct BoundaryDistances {
  double vertices = 0;  // from a vertex of the boundary to its place on the CAD
  double to_cad = 0;    // from the middle of a facet or of an edge of it to the CAD
  double from_cad = 0;  // from a point of CadShape::samples() to the nearest facet
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
  std::array<KindQuality, 4> cells{};                        // hexes, prisms, pyramids, tets, afterwards
  BoundaryDistances before, after;
  double diagonal = 0;  // of the CAD's bounding box
};

// Changes points of the mesh and the qualities of its cells. The mesh must have its boundary as tagged triangles and
// quads, and valid cells; all cells are valid afterwards, too.
FitcadResult fit_to_cad(MixedMesh& mesh, const CadShape& shape, const FitcadOptions& options);

// As docs and --stats name the figures.
nlohmann::ordered_json to_json(const FitcadResult& result);

}  // namespace hexpipe::fitcad
