#pragma once
// Steps of repair that make new triangles: for a hole, and for places where a surface intersects itself in a few
// triangles: folded slivers, corners that poke through.

#include <cstddef>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::tetmesh::solid {

// One edge of a hole's border. The edges come in the order in which the new triangles turn around the hole.
struct HoleEdge {
  Vertex start;
  Vertex across;  // the third corner of the triangle that is at the edge
};

// The triangulation, without new points, that bends least: the greatest angle between neighbouring triangles is least,
// those beside the hole included, and among such triangulations the area (P. Liepa: Filling holes in meshes, 2003).
// Empty where CGAL finds none. Time grows with the cube of the number of edges.
std::vector<Triangle> fill_hole(std::span<const Vec3> points, std::span<const HoleEdge> border);

struct FoldReport {
  std::size_t places = 0, triangles = 0;  // triangles that were replaced
};

struct FoldRule {
  double tolerance = 0;
  // A place is a disk of one tag, as its new triangles are, and distances are measured at more points.
  bool keeps_shape = false;
};

// Takes the triangles that intersect out, together with as few around them as leave a hole with one simple border, and
// fills the hole; its inner points go. A place is mended only if the new triangles intersect nothing and old and new
// ones are within the tolerance of each other, so that bodies that overlap stay as they are. Leaves places with borders
// or with edges of more than two triangles.
FoldReport remove_folds(formats::SurfaceSoup& soup, const FoldRule& rule);

}  // namespace hexpipe::tetmesh::solid
