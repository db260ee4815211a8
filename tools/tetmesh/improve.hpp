#pragma once
// The points of a mesh that stands, made better by search: search/point_search.hpp with TetGen behind it.

#include "tools/tetmesh/fill.hpp"

namespace hexpipe::tetmesh {

// From here on a first SIGINT or SIGTERM ends the search and not the process. Statistics of the search and of TetGen's
// time are added to those that are there.
void improve(FilledSurface& filled, const solid::Surface& given, const TetmeshOptions& options);

}  // namespace hexpipe::tetmesh
