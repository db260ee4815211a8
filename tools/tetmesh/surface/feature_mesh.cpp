#include "tools/tetmesh/surface/feature_mesh.hpp"

#include <algorithm>

#include "common/mesh/feature_angle.hpp"

namespace hexpipe::tetmesh::surface {

FeatureMesh::FeatureMesh(const solid::Surface& surface, double feature_angle)
    : corner_cosine_(cosine_of_degrees(feature_angle)) {
  reserve(surface.points.size(), 3 * surface.triangles.size() / 2, surface.triangles.size());
  for (const Vec3& p : surface.points) add_vertex(to_open_mesh(p));
  for (const Triangle& t : surface.triangles) add_face(vertex_handle(t[0]), vertex_handle(t[1]), vertex_handle(t[2]));
  resize_attributes();
  for (std::size_t f = 0; f < n_faces(); ++f) source_[f] = static_cast<std::int32_t>(f);
  mark_features(surface, feature_angle);
  mark_corners();
}

Vec3 FeatureMesh::area_normal(FaceHandle f) const {
  const auto [a, b, c] = corners(f);
  const Vec3 origin = position(a);
  return cross(position(b) - origin, position(c) - origin);
}

std::array<FeatureMesh::VertexHandle, 3> FeatureMesh::corners(FaceHandle f) const {
  const HalfedgeHandle h = halfedge_handle(f);
  return {from_vertex_handle(h), to_vertex_handle(h), to_vertex_handle(next_halfedge_handle(h))};
}

bool FeatureMesh::is_flat_around(VertexHandle v) const {
  Vec3 first;
  for (const FaceHandle f : vf_range(v)) {
    const Vec3 area = area_normal(f), normal = area * (1 / std::max(norm(area), 1e-300));
    if (norm_squared(first) == 0) first = normal;
    if (norm_squared(normal - first) > plane_tolerance * plane_tolerance) return false;
  }
  return true;
}

void FeatureMesh::resize_attributes() {
  edge_role_.resize(n_edges());
  on_feature_.resize(n_vertices());
  vertex_role_.resize(n_vertices(), VertexRole::removable);
  source_.resize(n_faces());
}

void FeatureMesh::mark_features(const solid::Surface& surface, double feature_angle) {
  const double cosine = cosine_of_degrees(feature_angle);
  for (const EdgeHandle e : edges()) {
    const FaceHandle f = face_handle(halfedge_handle(e, 0)), g = face_handle(halfedge_handle(e, 1));
    const Vec3 n = area_normal(f), m = area_normal(g);
    const bool sharp = dot(n, m) < cosine * norm(n) * norm(m);
    if (!sharp && surface.tags[source(f)] == surface.tags[source(g)]) continue;
    mark_feature(e, EdgeRole::feature);
  }
  for (const formats::CurveEdge& edge : surface.curves)
    if (const auto h = find_halfedge(vertex_handle(edge[0]), vertex_handle(edge[1])); h.is_valid())
      mark_feature(edge_handle(h), EdgeRole::feature);
}

void FeatureMesh::mark_feature(EdgeHandle e, EdgeRole role) {
  edge_role_[e.idx()] = role;
  on_feature_[to_vertex_handle(halfedge_handle(e, 0)).idx()] = 1;
  on_feature_[to_vertex_handle(halfedge_handle(e, 1)).idx()] = 1;
}

void FeatureMesh::add_crests(std::span<const EdgeHandle> edges) {
  for (const EdgeHandle e : edges) mark_feature(e, EdgeRole::crest);
  mark_corners();
}

void FeatureMesh::mark_corners() {
  for (const VertexHandle v : vertices())
    if (is_on_feature(v) && is_corner(v)) keep(v);
}

bool FeatureMesh::is_corner(VertexHandle v) const {
  int count = 0;
  std::array<Vec3, 2> directions;
  for (const HalfedgeHandle h : voh_range(v)) {
    if (!is_feature(edge_handle(h))) continue;
    if (count == 2) return true;
    const Vec3 d = position(to_vertex_handle(h)) - position(v);
    directions[count++] = unit(d);
  }
  return count != 2 || -dot(directions[0], directions[1]) < corner_cosine_;
}

FeatureMesh::VertexHandle FeatureMesh::add_removable(const Vec3& p, bool on_feature) {
  const VertexHandle v = add_vertex(to_open_mesh(p));
  resize_attributes();
  on_feature_[v.idx()] = on_feature;
  return v;
}

FeatureMesh::VertexHandle FeatureMesh::split_edge_at(EdgeHandle e, const Vec3& p) {
  const HalfedgeHandle h = halfedge_handle(e, 0);
  const VertexHandle ends[2] = {to_vertex_handle(h), from_vertex_handle(h)};
  const VertexHandle across = to_vertex_handle(next_halfedge_handle(h));
  const std::int32_t source_here = source(face_handle(h));
  const std::int32_t source_there = source(face_handle(opposite_halfedge_handle(h)));
  const EdgeRole role = edge_role_[e.idx()];
  const VertexHandle v = add_removable(p, is_feature(e));
  split(e, v);
  resize_attributes();
  for (const HalfedgeHandle out : voh_range(v)) {
    const VertexHandle end = to_vertex_handle(out);
    edge_role_[edge_handle(out).idx()] = end == ends[0] || end == ends[1] ? role : EdgeRole::none;
    const bool here = end == across || to_vertex_handle(next_halfedge_handle(out)) == across;
    source_[face_handle(out).idx()] = here ? source_here : source_there;
  }
  return v;
}

FeatureMesh::VertexHandle FeatureMesh::split_face_at(FaceHandle f, const Vec3& p) {
  const std::int32_t source_here = source(f);
  const VertexHandle v = add_removable(p, false);
  split(f, v);
  resize_attributes();
  for (const FaceHandle part : vf_range(v)) source_[part.idx()] = source_here;
  return v;
}

// Two pairs of edges become one edge each. The edge that survives is a feature if one of its pair was.
void FeatureMesh::collapse_edge(HalfedgeHandle h) {
  const VertexHandle end = to_vertex_handle(h);
  std::array<std::pair<VertexHandle, EdgeRole>, 2> sides;
  for (const unsigned side : {0u, 1u}) {
    const HalfedgeHandle next = next_halfedge_handle(side == 0 ? h : opposite_halfedge_handle(h));
    const HalfedgeHandle last = next_halfedge_handle(next);
    sides[side] = {to_vertex_handle(next),
                   std::max(edge_role_[edge_handle(next).idx()], edge_role_[edge_handle(last).idx()])};
  }
  collapse(h);
  for (const auto& [across, role] : sides) edge_role_[edge_handle(find_halfedge(end, across)).idx()] = role;
}

}  // namespace hexpipe::tetmesh::surface
