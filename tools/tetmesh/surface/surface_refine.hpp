#pragma once
// Makes a surface's triangles fit to carry a field, without moving the surface: flips flat edges and halves long ones.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

// Flips edges towards Delaunay triangles where the surface bends by less than `flatness`. Then halves edges, the
// longest first, until none is longer than `longest`. New vertices are removable.
void refine_surface(FeatureMesh& mesh, const sizing::SizeField& longest, const sizing::SizeField& flatness);

}  // namespace hexpipe::tetmesh::surface
