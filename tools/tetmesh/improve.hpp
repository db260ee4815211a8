#pragma once
// Makes the points of a finished mesh better by search: search/point_search.hpp with TetGen behind it.

#include <cstdint>
#include <optional>

#include "tools/tetmesh/meshing.hpp"

namespace hexpipe::tetmesh {

struct ImproveOptions {
  std::size_t rounds;
  std::uint64_t seed;
  std::optional<double> time_limit;  // seconds
  double tetgen_timeout;             // seconds for one mesh
};

// From this call on, a first SIGINT or SIGTERM ends the search and not the process. The figures of the search and the
// time of TetGen are added to the statistics of `meshed`.
void improve(MeshedSurface& meshed, const solid::Surface& given, const ImproveOptions& options);

}  // namespace hexpipe::tetmesh
