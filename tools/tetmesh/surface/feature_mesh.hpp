#pragma once
// The surface as a half-edge mesh that can be split, flipped and collapsed. It knows what must survive: feature edges,
// corners, and the triangle of the input that each face lies on.
//
// At joints, edges where more than two triangles meet, the mesh is cut into sheets (sheet_cut.hpp). Each sheet has its
// own copy of a joint, as an edge of its border or as a feature inside it, and of the joint's vertices. Copies lie in
// one place; they are split together and kept together.

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

using VertexH = OpenMesh::VertexHandle;
using HalfEdgeH = OpenMesh::HalfedgeHandle;
using EdgeH = OpenMesh::EdgeHandle;
using FaceH = OpenMesh::FaceHandle;

// Normals of length 1 that differ by less belong to one plane. Edges that bend by less than this share of their length
// lie in one plane.
inline constexpr double plane_tolerance = 1e-5;

enum class EdgeRole : std::uint8_t {
  none,
  crest,    // the middle of a fillet (crest_lines.hpp), which is kept like a feature
  feature,  // an edge of the surface's own features
  joint     // a feature at which more than two triangles meet
};

enum class VertexRole : std::uint8_t {
  removable,  // from the input, or added to refine it
  kept        // a vertex of the result
};

class FeatureMesh : public OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits> {
 public:
  // Feature edges are joints, and edges where the normals of neighbours differ by more than the angle (degrees), where
  // tags meet, and along the surface's own curves. Corners are the vertices where one feature edge or more than two
  // meet, where a curve turns by more than the angle, or where sheets touch in the vertex alone. Corners are kept.
  FeatureMesh(const solid::Surface& surface, double feature_angle);

  // False if a sheet meets itself along an edge; the mesh is empty then.
  bool is_manifold() const { return is_manifold_; }
  // A face at an edge; there are two, except at a border.
  FaceHandle face_at(EdgeHandle e) const {
    const FaceHandle f = face_handle(halfedge_handle(e, 0));
    return f.is_valid() ? f : face_handle(halfedge_handle(e, 1));
  }
  Vec3 position(VertexHandle v) const {
    const Point& p = point(v);
    return {p[0], p[1], p[2]};
  }
  // Its length is twice the area.
  Vec3 area_normal(FaceHandle f) const;
  std::array<VertexHandle, 3> corners(FaceHandle f) const;
  std::array<Vec3, 3> positions(FaceHandle f) const {
    const auto [a, b, c] = corners(f);
    return {position(a), position(b), position(c)};
  }
  // Whether the faces around v lie in one plane.
  bool is_flat_around(VertexHandle v) const;

  bool is_feature(EdgeHandle e) const { return edge_role_[e.idx()] != EdgeRole::none; }
  bool is_crest(EdgeHandle e) const { return edge_role_[e.idx()] == EdgeRole::crest; }
  bool is_on_feature(VertexHandle v) const { return on_feature_[v.idx()] != 0; }
  bool is_kept(VertexHandle v) const { return vertex_role_[v.idx()] == VertexRole::kept; }
  void keep(VertexHandle v) {
    for_each_copy(v, [&](VertexHandle copy) { vertex_role_[copy.idx()] = VertexRole::kept; });
  }
  // A face that is held is one of the result, with its corners.
  void hold(FaceHandle f) {
    is_held_.resize(n_faces());
    is_held_[f.idx()] = true;
    for (const VertexHandle v : corners(f)) keep(v);
  }
  bool is_held(FaceHandle f) const { return static_cast<std::size_t>(f.idx()) < is_held_.size() && is_held_[f.idx()]; }
  // The triangle of the input surface that a face lies on, or lay on before its corners were moved.
  std::int32_t source(FaceHandle f) const { return source_[f.idx()]; }

  bool is_joint(EdgeHandle e) const { return edge_role_[e.idx()] == EdgeRole::joint; }
  bool has_copies(VertexHandle v) const { return next_copy_[v.idx()] != v.idx(); }
  // A number that all copies of a vertex have in common: that of one of them.
  std::int32_t place(VertexHandle v) const { return place_[v.idx()]; }
  // Calls body(copy) for all copies of v; v itself comes first.
  template <class Body>
  void for_each_copy(VertexHandle v, Body&& body) const {
    int copy = v.idx();
    do {
      body(VertexHandle(copy));
      copy = next_copy_[copy];
    } while (copy != v.idx());
  }
  // The half-edges of an edge and of its copies, all from the place of h's start to that of its end.
  std::vector<HalfedgeHandle> copies(HalfedgeHandle h) const;
  // Whether a region is on both sides of the face.
  bool is_interface(FaceHandle f) const { return is_interface_[source(f)]; }

  // The surface as the mesh is now, with the input's tags, names and shells, but without its curves. Sheets are joined
  // again.
  solid::Surface to_surface(const solid::Surface& input) const;
  // By place, the number of its point in to_surface(); no_index where no vertex is left.
  std::vector<hexpipe::Vertex> point_numbers() const;
  // For each point of that surface, whether it is on a feature.
  std::vector<bool> points_on_features() const;

  // Edges that are features only because they are sharp become edges like others, and so do their corners.
  void forget_features(std::span<const EdgeHandle> edges);
  // Makes features of edges that are none.
  void add_crests(std::span<const EdgeHandle> edges);

  // Splits at a point of the edge or face; the point becomes a removable vertex, in each copy of an edge.
  VertexHandle split_edge_at(EdgeHandle e, const Vec3& p);
  VertexHandle split_face_at(FaceHandle f, const Vec3& p);
  // The edge of h no longer joins its own ends but the corners opposite to it. What was in front of the corner of h's
  // triangle goes to the other side, and if the edge was a feature, this goes by that corner now. Call is_flip_ok()
  // first; not for joints.
  void flip_behind_corner(HalfedgeHandle h);
  // Moves the start of a half-edge to its end. Call is_collapse_ok() first.
  void collapse_edge(HalfedgeHandle h);

 private:
  void join_ends(HalfedgeHandle h);
  void remove_loop(HalfedgeHandle h);
  void begin_at_border(VertexHandle v);
  VertexHandle add_removable(const Vec3& p, bool on_feature);
  VertexHandle split_one_edge_at(EdgeHandle e, const Vec3& p);
  void add_whole(const solid::Surface& surface);
  bool add_in_sheets(const solid::Surface& surface);
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
  std::vector<std::uint8_t> on_feature_;  // by vertex
  std::vector<VertexRole> vertex_role_;
  std::vector<int> next_copy_;        // by vertex, in a ring; a vertex without copies has itself
  std::vector<std::int32_t> place_;   // by vertex
  std::vector<std::int32_t> source_;  // by face
  std::vector<bool> is_held_;         // by face; empty until one is held
  std::vector<bool> is_interface_;    // by triangle of the input
};

inline OpenMesh::Vec3d to_open_mesh(const Vec3& p) {
  return {p.x, p.y, p.z};
}

}  // namespace hexpipe::tetmesh::surface
