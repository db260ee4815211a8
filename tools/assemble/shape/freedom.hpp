#pragma once
// Which way each vertex of a result may move so that boundary, interfaces and the borders of their tags stay as they
// are.

#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::shape {

// Vertices inside: anywhere. On tagged facets that all lie in one plane with one tag: in that plane. On tagged facets
// in two planes, with one tag in each: along their common line. All others: nowhere.
std::vector<Freedom> vertex_freedoms(const MixedMesh& mesh);

}  // namespace hexpipe::assemble::shape
