#pragma once
// The input's tagged triangles as a surface on which vertices slide and from which results deviate.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/mesh/vertex_items.hpp"

namespace hexpipe::assemble::shape {

// How far facets may lie from the input's surface after vertices slid on it or flat tets were peeled off it: in edge
// lengths there or, where the model is thinner than an edge is long, in its thickness. Circles of 25 edges and more
// deviate less between their own vertices.
inline constexpr double most_deviation = 0.03;

// By tagged triangle: how thick the mesh is behind it, from its middle at right angles into the tets on either side to
// where their region ends, and at most the triangle's `reach`. A triangle that is no facet of a tet has its `reach`.
std::vector<double> thickness_behind(const TetMesh& mesh, const TetAdjacency& adjacency, std::span<const double> reach);

class InputSurface {
 public:
  // The place of a vertex: on no tagged triangle; within a smooth patch of the surface; on a feature curve between two
  // patches; or where curves meet, end or turn. A ridge of the mesh is a feature, and so is an edge that is not smooth
  // (smooth_edges.hpp).
  enum class Place : std::uint8_t { inside, face, curve, corner };

  // `mesh` outlives this, and its surface is complete (surface_tags.hpp). `adjacency` is that of the mesh, and may go.
  InputSurface(const TetMesh& mesh, const TetAdjacency& adjacency);

  Place place(Vertex v) const { return places_[v]; }

  // The point nearest to `to` on the smooth patch or the curve on which v lies, found downhill from v, with the unit
  // normal or tangent there. For a corner, v itself.
  struct Foot {
    Vec3 at;
    Vec3 axis;
  };
  Foot foot(Vertex v, const Vec3& to) const;

  // The distance from `to` to the surface around v, across features too, and only as exact as it takes to compare it
  // with `enough`. It is too long if the way downhill ends early.
  double distance(Vertex v, const Vec3& to, double enough = 0) const;
  // The distance to the whole surface: looks at every triangle.
  double distance(const Vec3& to) const;

  // How far facets at v may lie from the surface. v is on a tagged triangle.
  double most_deviation_at(Vertex v) const { return most_deviation * lengths_[v]; }

  bool has_triangle(const Triangle& triangle) const;

  double diagonal() const { return diagonal_; }  // of the bounding box

 private:
  struct Nearest {
    std::int32_t triangle;
    Vec3 at;
    double distance_squared;
  };
  std::span<const std::int32_t> triangles_at(Vertex v) const { return triangles_.at(v); }
  void find_features();
  void find_lengths(const TetAdjacency& adjacency);
  double edge_length(Vertex v) const;
  Place place_of(Vertex v) const;
  bool is_one_fan(Vertex v) const;
  Nearest descend(Vertex v, const Vec3& to, bool within_patch, double enough) const;
  Foot foot_on_curve(Vertex v, const Vec3& to) const;

  const TetMesh& mesh_;
  double diagonal_ = 0;
  VertexItems triangles_;
  std::vector<std::int32_t> patch_;  // by triangle: one number for all that are joined without crossing a feature
  // The far ends of the feature edges at each vertex.
  std::vector<std::int64_t> feature_offsets_;
  std::vector<Vertex> feature_ends_;
  std::vector<Place> places_;
  // By vertex: the mean length of the edges of its triangles or the least thickness behind one of them; 0 inside.
  std::vector<double> lengths_;
};

}  // namespace hexpipe::assemble::shape
