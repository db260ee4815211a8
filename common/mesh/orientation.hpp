#pragma once
// Which tets of a mesh are inverted. The order in which a file lists a tet's corners says nothing by itself: some
// programs list them all in the negative sense, some in no particular order. A tet is inverted if it lies on the wrong
// side of the facets that it shares.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

struct TetOrientation {
  std::vector<std::int8_t>
      signs;  // of each tet's volume after it was turned: 1, 0 for a flat tet, -1 for an inverted one
  std::vector<std::int8_t> turns;  // 1 for each tet whose last two corners were swapped; empty if none was negative
  std::int64_t turned = 0;         // the number of tets turned
  std::int64_t inverted = 0;
  std::int64_t flat = 0;
};

// Turns tets so that in each component (connected by facets) all are listed in the same sense and as many as possible
// are positive. A mesh of positive tets stays unchanged. Throws DataError naming `source` when a facet belongs to more
// than two tets.
TetOrientation orient_tets(TetMesh& mesh, const char* source);

// The same, if it is already known which tets have to be turned (TetOrientation::turns).
TetOrientation orient_tets(TetMesh& mesh, std::vector<std::int8_t> turns);

// Throws DataError naming `source` when two positive tets lie on the same side of a facet that they share, such as two
// copies of a tet. The message counts tets and vertices from 1. `numbers` holds the numbers that the source gives the
// tets, from 0, if they differ from their places here.
void check_sides(const TetMesh& mesh, const TetAdjacency& adjacency, const char* source,
                 std::span<const TetIndex> numbers = {});

// A warning about the tets that were turned. There is one if they are few among many, which hints at a fault; there is
// none if the file lists all its tets in the other sense, or in no order.
std::optional<std::string> turned_tets_warning(const TetOrientation& orientation);

}  // namespace hexpipe
