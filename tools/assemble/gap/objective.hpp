#pragma once
// The objective by which the cells between the hexes become fewer and better: docs/definitions.md 4.

#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::assemble::gap {

// No cell may become worse than this, or than the worst cell that it replaces. open_hexes() alone goes down to
// least_wanted.
inline constexpr double least_quality = good_enough;
// Where a cell is worse than this, a new vertex is put beside it, or a chosen cell goes (open_hexes() in passes.hpp).
inline constexpr double least_wanted = 0.1;
// Changes that gain less are not worth it. Because each change gains this much, the passes end.
inline constexpr double least_gain = 0.01;

// The least scaled Jacobian over the corners: for a tet times the square root of 2, for a pyramid over its base.
double quality_of(CellKind kind, std::span<const Vec3> points, std::span<const Vertex> corners);

// The cost of a cell that is no hex: 1, and more where its quality is less than good. The objective is the sum over
// these cells and their faces.
double cost_of(double quality);

// What solvers refuse costs this at least, where that counts (GapMesh::be_strict()): a few more cells are better.
inline constexpr double price_of_refusal = 10;

// The cost of a face between two cells, from its measures (common/mesh/face_measures.hpp): nothing where it is good,
// and more where finite volumes suffer from it.
double cost_of_face(double orthogonality, double weight);
// What is added to it where solvers would refuse the mesh because of the weight (GapMesh::be_strict()).
double cost_of_refused_weight(double weight);

// The cost of a quad that solvers refuse because neither diagonal suits the cells on both sides (diagonal_sight()).
double cost_of_refused_sight(double sight);

// The cost of a cell whose faces to other cells do not span space well, from its determinant.
double cost_of_span(double determinant);
// What is added to it where solvers would refuse the mesh because of it.
double cost_of_refused_span(double determinant);

}  // namespace hexpipe::assemble::gap
