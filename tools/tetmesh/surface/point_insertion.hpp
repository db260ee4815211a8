#pragma once
// Makes points on a surface vertices of its mesh.

#include <span>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {

// Points name the faces of the mesh as it is now. Each becomes a kept vertex. Near a vertex, or an edge, within `snap`,
// no new one arises: where the surface is flat the vertex moves to the point, elsewhere it stands for the point where
// it is.
void insert_points(FeatureMesh& mesh, std::span<const SurfacePoint> points, const sizing::SizeField& snap);

}  // namespace hexpipe::tetmesh::surface
