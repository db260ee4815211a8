#pragma once
// Lines along the middle of small fillets. There a surface that is flat on both sides turns by about a right angle
// within about one size, like an edge that was rounded. Rows of points should go along such a line as along an edge.

#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/bend_stretch.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/field_surface.hpp"

namespace hexpipe::tetmesh::surface {

// The edges of the mesh that lie on such lines; only lines that are long against the size count.
std::vector<OpenMesh::EdgeHandle> crest_lines(const FeatureMesh& mesh, const sizing::SizeField& size);

// Adds the small fillets beside the half-edges that are crests: how much longer the way across them would be if their
// edge were not rounded, along the tangents of both sides.
void add_small_fillets(const FieldSurface& surface, BendStretch& stretch);

}  // namespace hexpipe::tetmesh::surface
