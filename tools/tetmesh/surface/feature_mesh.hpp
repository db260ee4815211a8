#pragma once
// The surface as a half-edge mesh that can be split, flipped and collapsed, with what must survive that: feature edges,
// corners, and the triangle of the input that each face lies on.
//
// Where sheets meet at edges of more than two triangles, joints, it is cut into pieces (sheet_cut.hpp). A joint is
// there once for each piece, as an edge of its border or a feature in it, and so is a vertex: as copies, which are in
// one place, split together and kept together.

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::surface {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};

// Normals of length 1 that differ by less are those of one plane; so are edges that bend by less than that part of
// their length.
inline constexpr double plane_tolerance = 1e-5;

enum class EdgeRole : std::uint8_t {
  none,
  crest,    // the middle of a fillet (crest_lines.hpp), which is kept as a feature is
  feature,  // one of the surface
  joint     // a feature at which more than two triangles meet
};

enum class VertexRole : std::uint8_t {
  removable,  // of the input, or added to refine it
  kept        // a vertex of the result
};

class FeatureMesh : public OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits> {
 public:
  // Feature edges: where normals of neighbours differ by more than the angle (degrees), where tags meet, and along the
  // surface's own curves, and joints. Corners, which are kept, are the vertices where other than two feature edges
  // meet, where a curve turns by more than it, or where pieces touch in the vertex alone.
  FeatureMesh(const solid::Surface& surface, double feature_angle);

  // False where a sheet meets itself along an edge: then the mesh is empty.
  bool is_manifold() const { return is_manifold_; }
  // A face at an edge: there is one on either side but at a border.
  FaceHandle face_at(EdgeHandle e) const {
    const FaceHandle f = face_handle(halfedge_handle(e, 0));
    return f.is_valid() ? f : face_handle(halfedge_handle(e, 1));
  }
  Vec3 position(VertexHandle v) const {
    const Point& p = point(v);
    return {p[0], p[1], p[2]};
  }
  // Twice the area long.
  Vec3 area_normal(FaceHandle f) const;
  std::array<VertexHandle, 3> corners(FaceHandle f) const;
  // Whether its faces lie in one plane.
  bool is_flat_around(VertexHandle v) const;

  bool is_feature(EdgeHandle e) const { return edge_role_[e.idx()] != EdgeRole::none; }
  bool is_crest(EdgeHandle e) const { return edge_role_[e.idx()] == EdgeRole::crest; }
  bool is_on_feature(VertexHandle v) const { return on_feature_[v.idx()] != 0; }
  bool is_kept(VertexHandle v) const { return vertex_role_[v.idx()] == VertexRole::kept; }
  void keep(VertexHandle v) {
    for_each_copy(v, [&](VertexHandle copy) { vertex_role_[copy.idx()] = VertexRole::kept; });
  }
  // The triangle of the input surface that a face lies on, or was before its corners were moved.
  std::int32_t source(FaceHandle f) const { return source_[f.idx()]; }

  bool is_joint(EdgeHandle e) const { return edge_role_[e.idx()] == EdgeRole::joint; }
  bool has_copies(VertexHandle v) const { return next_copy_[v.idx()] != v.idx(); }
  // The same number for all copies of a vertex: that of one of them, for others their own.
  std::int32_t place(VertexHandle v) const { return place_[v.idx()]; }
  // Beginning with the vertex itself.
  template <class Body>
  void for_each_copy(VertexHandle v, Body&& body) const {
    int copy = v.idx();
    do {
      body(VertexHandle(copy));
      copy = next_copy_[copy];
    } while (copy != v.idx());
  }
  // Of an edge, half-edges of it and of its copies, all from the place of h's start to that of its end.
  std::vector<HalfedgeHandle> copies(HalfedgeHandle h) const;
  // Whether a region is on both sides of the face.
  bool is_interface(FaceHandle f) const { return is_interface_[source(f)]; }

  // Makes edges features that are none.
  void add_crests(std::span<const EdgeHandle> edges);

  // Split at a point of the edge or face, which becomes a removable vertex; of an edge with copies, one in each.
  VertexHandle split_edge_at(EdgeHandle e, const Vec3& p);
  VertexHandle split_face_at(FaceHandle f, const Vec3& p);
  // Moves the start of a half-edge to its end. Check is_collapse_ok() first.
  void collapse_edge(HalfedgeHandle h);

 private:
  VertexHandle add_removable(const Vec3& p, bool on_feature);
  VertexHandle split_one_edge_at(EdgeHandle e, const Vec3& p);
  void add_whole(const solid::Surface& surface);
  bool add_in_pieces(const solid::Surface& surface);
  void join_copies(VertexHandle v, VertexHandle other);
  void mark_features(const solid::Surface& surface, double feature_angle);
  bool is_contact(VertexHandle v) const;
  void mark_feature(EdgeHandle e, EdgeRole role);
  void mark_corners();
  bool is_corner(VertexHandle v) const;
  void resize_attributes();

  double corner_cosine_;
  bool is_manifold_ = true;
  std::vector<EdgeRole> edge_role_;
  std::vector<std::uint8_t> on_feature_;  // of vertices
  std::vector<VertexRole> vertex_role_;
  std::vector<int> next_copy_;        // of vertices, in a ring; those without copies have themselves
  std::vector<std::int32_t> place_;   // of vertices
  std::vector<std::int32_t> source_;  // of faces
  std::vector<bool> is_interface_;    // of the input's triangles
};

inline OpenMesh::Vec3d to_open_mesh(const Vec3& p) {
  return {p.x, p.y, p.z};
}

}  // namespace hexpipe::tetmesh::surface
