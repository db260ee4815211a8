#pragma once
// A frame at every node of a mesh: on the surface along its normals and features, inside as smooth as can be.
//
// N. Ray, D. Sokolov, B. Lévy: Practical 3D Frame Field Generation (2016): the harmonic functions first, by one linear
// problem in which a surface node may only turn about its normal; then the frames nearest to them. Where the paper goes
// on with L-BFGS on angles, each frame is fitted here to the mean of its neighbours', a few times (the scheme of
// Merriman, Bence and Osher, as in Palmer, Bommes, Solomon 2020). Deviates also in that right-angled surface triangles
// suggest directions in the tangent plane.

#include <vector>

#include "tools/tetmesh/volume/field_nodes.hpp"

namespace hexpipe::tetmesh::volume {

std::vector<fields::Frame> solve_frame_field(const FieldNodes& nodes);

}  // namespace hexpipe::tetmesh::volume
