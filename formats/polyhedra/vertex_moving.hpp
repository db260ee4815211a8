#pragma once
// Vertices move a little, on the boundary along it, so that nothing is wrong any more with a cell.

#include <optional>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

struct Move {
  Cost cost{};
  std::int32_t cell = no_index;  // a cell of the vertex
  Vertex vertex = no_index;
  Vec3 place{};       // where it goes
  double length = 0;  // how far, by the shortest edge at the vertex
};

// The move of one vertex of the cell that costs least and leaves nothing wrong with the cell, and less around it than
// before; of moves that cost the same, the shortest.
std::optional<Move> best_move(MeasuredMesh& mesh, std::int32_t cell);

struct ClimbEffort {
  int steps;          // the most moves
  std::size_t tried;  // the most places that are tried for each of them
};

// Hill climbing: moves vertices of the cell one after the other. Each move lowers the cell's trouble() and leaves no
// more wrong around it. The moves are kept if nothing is wrong with the cell in the end, and less around it than
// before; `wrong_added` is what an earlier part of the same change has added around it. Returns the number of moves; 0
// if none is kept.
std::int64_t climb(MeasuredMesh& mesh, std::int32_t cell, std::int64_t wrong_added, ClimbEffort effort);

void move_vertex(MeasuredMesh& mesh, const Move& move);

}  // namespace hexpipe::polyhedra
