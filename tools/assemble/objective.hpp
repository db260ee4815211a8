#pragma once
// The objective by which the cells between the hexes become fewer and better: docs/definitions.md 4.

#include <array>
#include <cstdlib>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// No cell may become worse than this, or, where one there is worse already, than that one.

inline const double least_merged_quality = getenv("LQ")?atof(getenv("LQ")):0.12;

// The least scaled Jacobian over the corners; of a tet times the square root of 2, of a pyramid over those of its base.
double gap_quality(CellKind kind, std::span<const Vec3> points, std::span<const Vertex> corners);
double tet_quality(std::span<const Vec3> points, std::span<const Vertex> corners);
double pyramid_quality(std::span<const Vec3> points, std::span<const Vertex> corners);

// The cost of a cell that is no hex: 1 for each, and more for a poor one.
double cell_cost(double quality);

}  // namespace hexpipe
