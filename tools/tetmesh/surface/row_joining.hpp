#pragma once
// Joins rows of a surface's lattice where two of them end on a face, by stretching the surface between the ends.

#include <array>
#include <span>

#include "tools/tetmesh/fields/periodic_numbers.hpp"
#include "tools/tetmesh/surface/links_across.hpp"
#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// The periodic coordinates `phases` follow the links. On faces where rows are joined, the distances of the links become
// those of the joined rows, and the coordinates follow them. `targets` holds the coordinates of triangles beside
// features. The rows of a face stretch by at most `most_stretch` sizes from one triangle to the next.
void join_rows(SurfaceLinks& links, const LinksAcross& across, std::span<const std::array<fields::Complex, 2>> targets,
               double most_stretch, fields::PeriodicNumbers<2>& phases);

}  // namespace hexpipe::tetmesh::surface
