#pragma once
// Rows of a surface's lattice that end inside a face, and how two such ends are joined.

#include <array>
#include <cstdint>
#include <vector>

#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// The coordinates of the triangles' centres along both of their directions, in rows.
using RowCoordinates = std::vector<std::array<double, 2>>;

// For each half-edge with a link, along both directions of its triangle: the whole number of rows by which the
// neighbour's coordinate, as the link sees it, is ahead of the triangle's own.
using RowJumps = std::vector<std::array<std::int32_t, 2>>;

RowCoordinates row_coordinates(const fields::PeriodicNumbers<2>& phases);

// The jumps with which neighbours' coordinates differ least.
RowJumps row_jumps(const SurfaceLinks& links, const RowCoordinates& coordinates);

// The number of rows that end at each vertex: the sum of the absolute values of what the jumps around it add up to. It
// is 0 on features, and where the field turns around a vertex.
std::vector<std::int32_t> row_ends(const SurfaceLinks& links, const RowJumps& jumps);

// How many rows end on faces.
std::int64_t count_row_ends(const SurfaceLinks& links, const fields::PeriodicNumbers<2>& phases);

// Changes jumps so that two ends of opposite sense cancel, the nearest first, where at most `reach` sizes lie between
// them. No path leads over a feature.
void join_row_ends(const SurfaceLinks& links, double reach, RowJumps& jumps);

}  // namespace hexpipe::tetmesh::surface
