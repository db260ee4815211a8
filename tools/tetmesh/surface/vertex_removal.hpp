#pragma once
// Takes the removable vertices out of a surface mesh, by collapses and flips that keep it near to where it was.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"

namespace hexpipe::tetmesh::surface {

// The mesh is changed in regions of about this many vertices at the same time. With half as many, more vertices are
// left for where regions meet.
inline constexpr std::size_t region_vertices = 8000;

// Feature curves stay where they are, apart from their removed vertices. No face turns over. Every removed vertex stays
// within `deviation` of the faces that took its place, and these stay within it of the original surface. Vertices that
// cannot be removed in this way stay. Returns their number. The mesh's deleted elements are left in it.
std::size_t remove_vertices(FeatureMesh& mesh, const DistanceIndex& original, const sizing::SizeField& deviation);

}  // namespace hexpipe::tetmesh::surface
