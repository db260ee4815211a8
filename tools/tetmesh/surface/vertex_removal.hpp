#pragma once
// Takes the removable vertices out of a surface mesh, by collapses and flips that keep it near to where it was.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"

namespace hexpipe::tetmesh::surface {

// It is done in regions of about so many vertices at the same time: with half as many, more are left for where regions
// meet.
inline constexpr std::size_t region_vertices = 8000;

// Feature curves stay where they are but for their removed vertices, no face turns over, every removed vertex stays
// within `deviation` of the faces that took its place, and these within it of the original surface. What cannot be
// removed so stays. Returns how many stayed. The
// mesh's deleted elements are left in it.
std::size_t remove_vertices(FeatureMesh& mesh, const DistanceIndex& original, const sizing::SizeField& deviation);

}  // namespace hexpipe::tetmesh::surface
