#pragma once
// Makes points on a surface vertices of its mesh.

#include <span>

#include "tools/tetmesh/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe {

// Points name the faces of the mesh as it is now. Each becomes a kept vertex; one nearer than `snap` to a vertex or an
// edge is moved there.
void insert_points(FeatureMesh& mesh, std::span<const SurfacePoint> points, const SizeField& snap);

}  // namespace hexpipe
