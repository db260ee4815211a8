#pragma once
// A cell is cut in two by a triangle from the middle of an edge to the other corners of two faces there. So a tet with
// two facets on the boundary becomes two tets, and the face between them has the direction that their other inner faces
// lack for a larger determinant.

#include <optional>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

struct Cut {
  Cost cost{};
  std::int32_t cell = no_index;
  Vertex from = no_index, to = no_index;     // the edge that is halved
  Vertex left = no_index, right = no_index;  // a corner of each face at it; an edge of the cell joins them
  double depth = 0;                          // how far the middle moves into the cell, by the length of the edge
};

// The cheapest cut of the cell that leaves nothing wrong with its parts, and less around them than before. `most_hexes`
// is the volume of hexes that may become polyhedra.
std::optional<Cut> best_cut(MeasuredMesh& mesh, std::int32_t cell, double most_hexes);

// Makes the cut. The middle moves away from the cells behind the two faces, so that the halves of these faces are
// convex for them, and becomes a corner of all faces around the edge. False, and nothing is changed, if the edge is not
// one of two faces of the cell.
bool cut_cell(MeasuredMesh& mesh, const Cut& cut);

}  // namespace hexpipe::polyhedra
