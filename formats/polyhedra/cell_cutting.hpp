#pragma once
// A cell is cut in two from the middle of an edge: so a tet with two facets on the boundary becomes two tets, each with
// a face between them that has the direction which its other inner faces lack.

#include <optional>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

struct Cut {
  Worth worth{};
  std::int32_t cell = no_index;
  Vertex from = no_index, to = no_index;     // the edge
  Vertex left = no_index, right = no_index;  // corners of the two faces at the edge, and ends of an edge of the cell
  double depth = 0;                          // how far the edge's middle moves into the cell, by the edge's length
};

// The best way to cut the cell that leaves nothing wrong with its parts, and less around them than before.
std::optional<Cut> best_cut(MeasuredMesh& mesh, std::int32_t cell, double most_hexes);

// The middle moves so that the halves of both faces are convex for the cells behind them, and all faces around the edge
// get it as a corner. False if the edge is not one that two faces of the cell have; nothing is changed then.
bool cut_cell(MeasuredMesh& mesh, const Cut& cut);

}  // namespace hexpipe::polyhedra
