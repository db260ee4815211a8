#pragma once
// A refined surface as plain arrays, with the sizes asked for, for the cross field and for walks along it.

#include <optional>
#include <vector>

#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

// A triangle that stands for an area: its own and that of triangles before it.
struct AreaSample {
  std::int32_t triangle;
  double area;
  double squares;  // the area in squares of the size
};

struct FieldSurface {
  // Faces and vertices have the same numbers as in the mesh, which must have no deleted elements.
  FieldSurface(const FeatureMesh& mesh, const sizing::SizeField& size,
               const std::optional<sizing::SizeField>& chord_height = {});

  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<geometry::HalfEdge> twins;  // at a border, where all edges are features: the half-edge itself
  std::vector<bool> feature;              // by half-edge
  std::vector<std::int32_t> joint;        // by half-edge: the number of its joint, where sheets meet, or no_index
  std::vector<bool> crest;                // the features in the middle of a fillet
  std::vector<Vec3> centres;
  std::vector<Vec3> normals;  // of length 1
  std::vector<double> areas;
  std::vector<double> sizes;  // in the middle of each triangle
  // By triangle: how far a straight line from one row of points to the next may leave the surface. Empty: by anything.
  std::vector<double> chord_heights;
  std::vector<bool> is_interface;     // by triangle: a region is on both of its sides
  std::vector<Vec3> alongs, inwards;  // by half-edge, see along() and inward()

  Vec3 edge_vector(geometry::HalfEdge h) const {
    return points[geometry::end_of(triangles, h)] - points[geometry::start_of(triangles, h)];
  }
  // The direction of a half-edge, of length 1.
  const Vec3& along(geometry::HalfEdge h) const { return alongs[h]; }
  // The direction at right angles to a half-edge in the plane of its triangle, of length 1, that points into the
  // triangle.
  const Vec3& inward(geometry::HalfEdge h) const { return inwards[h]; }
  // The area of a triangle in squares of the size.
  double squares_of_size(std::int32_t triangle) const { return areas[triangle] / (sizes[triangle] * sizes[triangle]); }
  // Triangles that each stand for at least this many squares of the size. What is left over at the end has no sample.
  std::vector<AreaSample> samples(double least_squares) const;
};

// The number that a half-edge of the mesh has on the surface.
geometry::HalfEdge half_edge_of(const FeatureMesh& mesh, OpenMesh::HalfedgeHandle h);

// A frame of a triangle's plane: its first side, and the direction 90 degrees to the left of it.
struct TangentFrame {
  Vec3 x, y;

  TangentFrame(const FieldSurface& surface, std::int32_t triangle);
};

}  // namespace hexpipe::tetmesh::surface
