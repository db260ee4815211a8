#pragma once
// Cuts the polygons of a file into triangles.

#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::formats {

// `fan` has the triangles of one polygon, fanned from its first corner. If one of them is turned against the polygon,
// as happens where it is concave, cuts the polygon again into as many triangles, by cutting off ears in the projection
// along an axis (G. H. Meisters: Polygons have ears, 1975). A polygon without ears, because it crosses itself, or with
// more than 10,000 corners stays a fan. The time grows with the square of the number of corners.
void cut_if_concave(std::span<const Vec3> points, std::span<Triangle> fan);

}  // namespace hexpipe::formats
