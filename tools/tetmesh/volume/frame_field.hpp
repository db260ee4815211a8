#pragma once
// A frame at every node of a mesh: on the surface along its normals and features, inside as smooth as possible.
//
// The method is that of N. Ray, D. Sokolov, B. Lévy: Practical 3D Frame Field Generation (2016). The harmonic functions
// come first, from one linear problem in which a surface node may only turn about its normal; then the frames nearest
// to them. The paper continues with L-BFGS on angles. Here the functions diffuse for a shorter and shorter time, and
// become the nearest frames, in turns: the scheme of Merriman, Bence and Osher (D. Palmer, D. Bommes, J. Solomon:
// Algebraic Representations for Volumetric Frame Fields, 2020). At last each frame is fitted to the mean of its
// neighbours' a few times. Another difference: right-angled surface triangles suggest directions in the tangent plane.

#include <vector>

#include "tools/tetmesh/volume/field_nodes.hpp"

namespace hexpipe::tetmesh::volume {

std::vector<fields::Frame> solve_frame_field(const FieldNodes& nodes);

}  // namespace hexpipe::tetmesh::volume
