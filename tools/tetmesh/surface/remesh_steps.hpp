#pragma once
// The steps in which a surface's triangles are made anew: they are prepared for a field, points become vertices, and
// the old vertices go.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"

namespace hexpipe::tetmesh::surface {

// The surface with fewer triangles: all points of the given one are within `tolerance` of it, and edges that come
// instead are at most `longest`. Features, corners and the surface's own curves stay as they are, except sharp edges
// that together are far shorter than that; no edge becomes a feature. Time is linear in the triangles. A surface whose
// sheets meet themselves along an edge is returned as it is.
solid::Surface thin_out(const solid::Surface& surface, double feature_angle, const sizing::SizeField& tolerance,
                        const sizing::SizeField& longest);

// 1 for an equilateral triangle, 0 for one without area. `area_normal` is twice as long as the area.
inline double shape_of(const std::array<Vec3, 3>& c, const Vec3& area_normal) {
  const double sides = norm_squared(c[1] - c[0]) + norm_squared(c[2] - c[1]) + norm_squared(c[0] - c[2]);
  return 2 * std::sqrt(3.0) * norm(area_normal) / std::max(sides, 1e-300);
}

// Flips edges towards Delaunay triangles where the surface bends by less than `flatness`. Then halves edges, the
// longest first, until none is longer than `longest`. New vertices are removable.
void refine_surface(FeatureMesh& mesh, const sizing::SizeField& longest, const sizing::SizeField& flatness);

// The points name the faces of the mesh as it is now. Each point becomes a kept vertex. A point within `snap` of a
// vertex or of an edge makes no new vertex next to it: where the surface is flat, the vertex moves to the point;
// elsewhere the vertex stays, and stands for the point.
void insert_points(FeatureMesh& mesh, std::span<const SurfacePoint> points, const sizing::SizeField& snap);

// What went wrong when vertices were removed before.
struct CloseWatch {
  std::vector<Vec3> left_behind = {};   // points of the original surface from which the faces came too far
  std::vector<Vec3> strayed = {};       // points of faces that came too far from the original surface
  std::vector<Vec3> other_faults = {};  // where nothing came too far, but the surface was not as promised

  // The places of all kinds.
  std::array<const std::vector<Vec3>*, 3> faults() const { return {&other_faults, &left_behind, &strayed}; }
};

// The mesh is changed in regions of about this many vertices at the same time. With half as many, more vertices are
// left for where regions meet.
inline constexpr std::size_t region_vertices = 8000;

// What the removal of vertices may do.
struct RemovalLimits {
  sizing::SizeField deviation;     // from the original surface
  sizing::SizeField longest_edge;  // of edges whose end moves, unless they were longer
  // Faces without a firm corner may come this many deviations from the original surface, for their corners step out of
  // it at last (bulges.hpp), so that the distance is shared between its two sides. 1: none does.
  double bulge = 1;
};

// Feature curves stay where they are, apart from their removed vertices. No face turns over. Every removed vertex stays
// within the deviation of the faces that took its place, and these stay within it of the original surface, or within
// 1.15 times as much where that mends a sliver. Both are measured at few points; what is watched closely is measured at
// more. Near faults that are known no face bulges. Vertices that cannot be removed in this way stay. Returns their
// number. The mesh must have no deleted elements; those of this step are left in it.
std::size_t remove_vertices(FeatureMesh& mesh, const DistanceIndex& original, const RemovalLimits& limits,
                            const CloseWatch& watch = {});

}  // namespace hexpipe::tetmesh::surface
