#pragma once
// A refined surface as plain arrays, and what sizes are asked for on it, for the cross field and for walks along it.

#include <vector>

#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

// A triangle that stands for an area: its own and that of triangles before it.
struct AreaSample {
  std::int32_t triangle;
  double area;
  double squares;  // as many of the size
};

struct FieldSurface {
  // Faces and vertices have the numbers that they have in the mesh, which must have nothing deleted.
  FieldSurface(const FeatureMesh& mesh, const sizing::SizeField& size);

  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<geometry::HalfEdge> twins;  // at a border, where all edges are features, themselves
  std::vector<bool> feature;              // of each half-edge
  std::vector<std::int32_t> joint;        // of each half-edge where sheets meet, the number of its joint; else -1
  std::vector<bool> crest;                // those of these that are in the middle of a fillet
  std::vector<Vec3> centres;
  std::vector<Vec3> normals;  // of length 1
  std::vector<double> areas;
  std::vector<double> sizes;       // in the middle of each triangle
  std::vector<bool> is_interface;  // of each triangle: a region is on both of its sides
  std::vector<Vec3> inwards;       // of each half-edge, see inward()

  Vec3 edge_vector(geometry::HalfEdge h) const {
    return points[geometry::end_of(triangles, h)] - points[geometry::start_of(triangles, h)];
  }
  // At right angles to a half-edge in the plane of its triangle, of length 1, pointing into it.
  const Vec3& inward(geometry::HalfEdge h) const { return inwards[h]; }
  // Of a triangle's area.
  double squares_of_size(std::int32_t triangle) const { return areas[triangle] / (sizes[triangle] * sizes[triangle]); }
  // Triangles that each stand for at least so many squares of the size; what the last ones lack is left out.
  std::vector<AreaSample> samples(double least_squares) const;
};

// The half-edge of the surface that is one of the mesh's.
geometry::HalfEdge half_edge_of(const FeatureMesh& mesh, OpenMesh::HalfedgeHandle h);

// A frame of a triangle's plane: its first side, and that turned by 90 degrees.
struct TangentFrame {
  Vec3 x, y;

  TangentFrame(const FieldSurface& surface, std::int32_t triangle);
};

}  // namespace hexpipe::tetmesh::surface
