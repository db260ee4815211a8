#pragma once
// Lines along the middle of small fillets. There a surface that is flat on both sides turns by about a right angle
// within about one size, like an edge that was rounded. Rows of points should go along such a line as along an edge.

#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/field_surface.hpp"

namespace hexpipe::tetmesh::surface {

// The edges of the mesh that lie on such lines; only lines that are long against the size count.
std::vector<OpenMesh::EdgeHandle> crest_lines(const FeatureMesh& mesh, const sizing::SizeField& size);

// How many times as long as they are ways across bends of the surface count.
struct BendStretch {
  std::vector<double> factor;  // of each triangle, for the way across the bend; 1 elsewhere
  std::vector<Vec3> along;     // the direction along the bend, whose lengths do not change

  explicit BendStretch(std::size_t triangles) : factor(triangles, 1.0), along(triangles) {}

  // The factor for a direction of length 1 in the triangle's plane.
  double in_direction(std::int32_t triangle, const Vec3& direction) const {
    const double cosine = dot(direction, along[triangle]);
    return 1 + (factor[triangle] - 1) * (1 - cosine * cosine);
  }
};

// Adds the small fillets beside the half-edges that are crests: how much longer the way across them would be if their
// edge were not rounded, along the tangents of both sides.
void add_small_fillets(const FieldSurface& surface, BendStretch& stretch);

}  // namespace hexpipe::tetmesh::surface
