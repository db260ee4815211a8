#pragma once
// Triangles for the polygons of a file.

#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::formats {

// Cuts anew what was fanned from its first corner, if a triangle of the fan is turned against the polygon, as happens
// where that is concave: by cutting off ears, in the projection along an axis (G. H. Meisters: Polygons have ears,
// 1975). What has no such ears, as it crosses itself, or more than 10,000 corners stays a fan. The triangles are as
// many as before. Time grows with the square of the number of corners.
void cut_if_concave(std::span<const Vec3> points, std::span<Triangle> fan);

}  // namespace hexpipe::formats
