#pragma once
// A vertex inside the mesh moves a little, so that nothing is wrong any more with the cells around it.

#include <optional>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

struct Move {
  Worth worth{};
  std::int32_t cell = no_index;  // that has the vertex
  Vertex vertex = no_index;
  Vec3 place{};
  double length = 0;
};

// The shortest move of a vertex of the cell that leaves nothing wrong with the cell, and less around it than before.
std::optional<Move> best_move(MeasuredMesh& mesh, std::int32_t cell);

struct ClimbEffort {
  int steps;          // moves
  std::size_t tried;  // for each of them
};

// Several moves of vertices of the cell, each of which brings it nearer to having nothing wrong, and leaves no more
// wrong around it: made if the last one gets there. Returns how many; 0 if there is no such way.
std::int64_t climb(MeasuredMesh& mesh, std::int32_t cell, std::int64_t refused_before, ClimbEffort effort);

bool move_vertex(MeasuredMesh& mesh, const Move& move);

}  // namespace hexpipe::polyhedra
