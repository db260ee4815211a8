#pragma once
// Makes vertices of the mesh from points on its surface.

#include <span>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {

// The points name the faces of the mesh as it is now. Each point becomes a kept vertex. A point within `snap` of a
// vertex or of an edge makes no new vertex next to it: where the surface is flat, the vertex moves to the point;
// elsewhere the vertex stays, and stands for the point.
void insert_points(FeatureMesh& mesh, std::span<const SurfacePoint> points, const sizing::SizeField& snap);

}  // namespace hexpipe::tetmesh::surface
