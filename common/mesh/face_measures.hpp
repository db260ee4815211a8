#pragma once
// How faces and cells suit finite volumes: the measures of OpenFOAM's checkMesh (version 1912), by the same formulas.

#include <array>
#include <cstdint>
#include <numbers>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// A flat stand-in for a face. `area` is at right angles to it, as long as the face is large, and outward where the
// corners are counter-clockwise as seen from outside.
struct FaceShape {
  Vec3 area{}, centre{};
};

// For three corners or more. If there are more, triangles around their mean make up the face, and its centre is the
// mean of the triangles' centres, weighted by their areas.
FaceShape face_shape(std::span<const Vec3> corners);

// The pyramids from the mean of the faces' centres to the faces: their common centre of mass, and their volume.
struct CellShape {
  Vec3 centre{};
  double volume = 0;
};
// The areas of the faces point outward.
CellShape cell_shape(std::span<const FaceShape> faces);
Vec3 cell_centre(CellKind kind, std::span<const Vec3> corners);

// The cosine of the angle between a face's normal and the line from the centre of the cell behind it to that of the
// cell before it; 1 is best. checkMesh calls a face severely non-orthogonal where the angle is more than 70 degrees.
double orthogonality(const FaceShape& face, const Vec3& behind, const Vec3& before);
inline constexpr double severe_angle = 70 * std::numbers::pi / 180;

// How evenly the face halves the way between the two centres: from 0 to 0.5, which is best. checkMesh counts faces
// below 0.05.
double face_weight(const FaceShape& face, const Vec3& behind, const Vec3& before);
inline constexpr double low_weight = 0.05;

// How far the line between the two centres passes the centre of the face, in widths of the face in that direction or
// fifths of the line. On the boundary, where nothing is before the face, the line ends on its plane. checkMesh counts
// faces above 4.
double face_skewness(std::span<const Vec3> corners, const FaceShape& face, const Vec3& behind, const Vec3* before);
inline constexpr double most_skewness = 4;

// checkMesh counts faces between two cells if the volume of one is a smaller part of the other's.
inline constexpr double low_volume_ratio = 0.01;

// The length of the face's area by the areas of its triangles: 1 for a flat one. checkMesh counts faces below 0.8.
double face_flatness(std::span<const Vec3> corners);
inline constexpr double low_flatness = 0.8;

// How well a diagonal of a quad suits the cells on both sides: the least height of the two centres over the planes of
// its two triangles, in roots of the face's area, for the better diagonal. checkMesh counts the face among its bad
// "face tets" where it is not positive. The corners are counter-clockwise as seen from `before`.
double diagonal_sight(std::span<const Vec3> corners, const Vec3& behind, const Vec3& before);

// How well the faces that have a neighbour span space: the determinant of the sum of the squares (dyads) of their areas
// by their mean size, over 8. 1 for a cube that has six neighbours, 0 for a cell that has two or less. `inner` tells
// for each face, triangles before quads as in cell_topology.hpp, whether it has one. checkMesh counts cells below
// 0.001.
double cell_determinant(CellKind kind, std::span<const Vec3> corners, std::span<const std::uint8_t> inner);
inline constexpr double low_determinant = 0.001;
// The same of a cell of any kind: the areas of its faces that have a neighbour.
double cell_determinant(std::span<const Vec3> inner_areas);

// Whether the centre of each face lies behind the plane of each other one, as checkMesh wants it: two faces in one
// plane make a cell "concave", too. The areas point outward.
bool is_convex(std::span<const FaceShape> faces);

}  // namespace hexpipe
