#pragma once
// Lines along the middle of small fillets: where a surface that is flat on both sides turns by about a right angle
// within a size or so, as an edge does that was rounded. Rows of points are to go along them as along an edge.

#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/field_surface.hpp"

namespace hexpipe::tetmesh::surface {

// Edges of the mesh in chains that are long against the size.
std::vector<OpenMesh::EdgeHandle> crest_lines(const FeatureMesh& mesh, const sizing::SizeField& size);

// How much longer the way across a fillet would be had its edge not been rounded: over the tangents of both its sides.
struct BendStretch {
  std::vector<double> factor;  // of each triangle; 1 off fillets
  std::vector<Vec3> along;     // the direction in which it is not

  // That of a direction of length 1 in the triangle's plane.
  double in_direction(std::int32_t triangle, const Vec3& direction) const {
    const double cosine = dot(direction, along[triangle]);
    return 1 + (factor[triangle] - 1) * (1 - cosine * cosine);
  }
};

// Beside the half-edges that are crests.
BendStretch bend_stretch(const FieldSurface& surface);

}  // namespace hexpipe::tetmesh::surface
