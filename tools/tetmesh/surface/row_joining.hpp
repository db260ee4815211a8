#pragma once
// Rows of a surface's lattice that are joined where two of them end on a face, by stretching what lies between.

#include <array>
#include <span>

#include "tools/tetmesh/fields/periodic_numbers.hpp"
#include "tools/tetmesh/surface/links_across.hpp"
#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// Of periodic coordinates that follow the links: on faces where rows are joined the distances of the links become those
// of the joined rows, and the coordinates follow. `targets` hold the coordinates of triangles beside features. Rows of
// a face stretch, from one triangle to the next, by at most `most_stretch` sizes.
void join_rows(SurfaceLinks& links, const LinksAcross& across, std::span<const std::array<fields::Complex, 2>> targets,
               double most_stretch, fields::PeriodicNumbers<2>& phases);

}  // namespace hexpipe::tetmesh::surface
