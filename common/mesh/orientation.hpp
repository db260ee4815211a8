#pragma once
// Which tets of a mesh are inverted. The order in which a file lists a tet's corners says nothing by itself: some
// programs list them all in the negative sense, some in no order at all. A tet is inverted when it lies on the wrong
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
  std::vector<std::int8_t> turns;  // 1 for each tet whose last two corners were swapped; empty where none was negative
  std::int64_t turned = 0;         // how many were
  std::int64_t inverted = 0;
  std::int64_t flat = 0;
};

// Turns tets so that in each part of the mesh that hangs together by facets all are listed in one sense, and as many as
// possible are positive. A mesh of positive tets stays as it is. Throws DataError naming `source` when a facet belongs
// to more than two tets.
TetOrientation orient_tets(TetMesh& mesh, const char* source);

// The same where it was found before which tets are to be turned: as TetOrientation::turns.
TetOrientation orient_tets(TetMesh& mesh, std::vector<std::int8_t> turns);

// Throws DataError naming `source`, and the tets and vertices from 1, where two positive tets lie on the same side of a
// facet that they share, as two copies of a tet do; `numbers`: what tets are called there from 0, if not by their
// places.
void check_sides(const TetMesh& mesh, const TetAdjacency& adjacency, const char* source,
                 std::span<const std::int32_t> numbers = {});

// What to tell a user of the tets that were turned: something where they are few among many, which hints at a fault;
// nothing where the file lists its tets in another sense, or in no order.
std::optional<std::string> turned_tets_warning(const TetOrientation& orientation);

}  // namespace hexpipe
