#include "tools/tetmesh/surface/feature_mesh.hpp"

#include <algorithm>
#include <utility>

#include "common/mesh/defaults.hpp"
#include "tools/tetmesh/surface/sheet_cut.hpp"

namespace hexpipe::tetmesh::surface {

FeatureMesh::FeatureMesh(const solid::Surface& surface, double feature_angle)
    : corner_cosine_(cosine_of_degrees(feature_angle)) {
  reserve(surface.points.size(), 3 * surface.triangles.size() / 2, surface.triangles.size());
  if (!surface.has_sheets) add_whole(surface);
  if (surface.has_sheets && !add_in_sheets(surface)) {
    is_manifold_ = false;
    return;
  }
  for (std::size_t f = 0; f < n_faces(); ++f) {
    source_[f] = static_cast<std::int32_t>(f);
    is_interface_.push_back(surface.shells[surface.shell_of[f]].in_front != solid::outside_region);
  }
  mark_features(surface, feature_angle);
  mark_corners();
}

void FeatureMesh::add_whole(const solid::Surface& surface) {
  for (const Vec3& p : surface.points) add_vertex(to_open_mesh(p));
  for (const Triangle& t : surface.triangles) add_face(vertex_handle(t[0]), vertex_handle(t[1]), vertex_handle(t[2]));
  resize_attributes();
}

bool FeatureMesh::add_in_sheets(const solid::Surface& surface) {
  const SheetCut cut = cut_along_joints(surface);
  if (!cut.is_manifold) return false;
  for (const std::int32_t point : cut.point_of) add_vertex(to_open_mesh(surface.points[point]));
  for (const Triangle& t : cut.triangles) add_face(vertex_handle(t[0]), vertex_handle(t[1]), vertex_handle(t[2]));
  resize_attributes();
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(cut.point_of.size()); ++v)
    if (cut.point_of[v] != v) join_copies(VertexHandle(cut.point_of[v]), VertexHandle(v));
  for (const auto& [from, to] : cut.joints)
    mark_feature(edge_handle(find_halfedge(VertexHandle(from), VertexHandle(to))), EdgeRole::joint);
  return true;
}

// `other` has none yet.
void FeatureMesh::join_copies(VertexHandle v, VertexHandle other) {
  std::swap(next_copy_[v.idx()], next_copy_[other.idx()]);
  place_[other.idx()] = place_[v.idx()];
}

Vec3 FeatureMesh::area_normal(FaceHandle f) const {
  const auto [a, b, c] = positions(f);
  return cross(b - a, c - a);
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

solid::Surface FeatureMesh::to_surface(const solid::Surface& input) const {
  formats::SurfaceSoup soup;
  soup.text = input.text;
  soup.name = input.name;
  soup.names = input.names;
  const std::vector<hexpipe::Vertex> number = point_numbers();
  for (const VertexHandle v : vertices())
    if (number[place(v)] == static_cast<hexpipe::Vertex>(soup.points.size())) soup.points.push_back(position(v));
  const auto shell = [&](FaceHandle f) { return input.shell_of[source(f)]; };
  std::vector<FaceHandle> in_order(faces().begin(), faces().end());
  std::ranges::stable_sort(in_order, {}, shell);
  std::vector<std::int32_t> shells;
  for (const FaceHandle f : in_order) {
    const auto [a, b, c] = corners(f);
    soup.triangles.push_back({number[place(a)], number[place(b)], number[place(c)]});
    if (input.has_sheets) soup.sides.push_back(input.sides[source(f)]);
    soup.tags.push_back(input.tags[source(f)]);
    soup.places.push_back(input.places[source(f)]);
    shells.push_back(shell(f));
  }
  return solid::with_shells_of(input, std::move(soup), std::move(shells));
}

std::vector<hexpipe::Vertex> FeatureMesh::point_numbers() const {
  std::vector<hexpipe::Vertex> number(n_vertices(), no_index);
  hexpipe::Vertex next = 0;
  for (const VertexHandle v : vertices())
    if (hexpipe::Vertex& known = number[place(v)]; known == no_index) known = next++;
  return number;
}

std::vector<bool> FeatureMesh::points_on_features() const {
  const std::vector<hexpipe::Vertex> number = point_numbers();
  std::vector<bool> result;
  for (const VertexHandle v : vertices())
    if (number[place(v)] == static_cast<hexpipe::Vertex>(result.size())) result.push_back(is_on_feature(v));
  return result;
}

void FeatureMesh::resize_attributes() {
  edge_role_.resize(n_edges());
  on_feature_.resize(n_vertices());
  vertex_role_.resize(n_vertices(), VertexRole::removable);
  for (std::size_t v = next_copy_.size(); v < n_vertices(); ++v) {
    next_copy_.push_back(static_cast<int>(v));
    place_.push_back(static_cast<std::int32_t>(v));
  }
  source_.resize(n_faces());
}

void FeatureMesh::mark_features(const solid::Surface& surface, double feature_angle) {
  const double cosine = cosine_of_degrees(feature_angle);
  for (const EdgeHandle e : edges()) {
    if (is_joint(e)) continue;
    const FaceHandle f = face_handle(halfedge_handle(e, 0)), g = face_handle(halfedge_handle(e, 1));
    const Vec3 n = area_normal(f), m = area_normal(g);
    const bool sharp = dot(n, m) < cosine * norm(n) * norm(m);
    if (!sharp && surface.tags[source(f)] == surface.tags[source(g)]) continue;
    mark_feature(e, EdgeRole::feature);
  }
  for (const formats::CurveEdge& edge : surface.curves)
    for_each_copy(vertex_handle(edge[0]), [&](VertexHandle from) {
      for_each_copy(vertex_handle(edge[1]), [&](VertexHandle to) {
        const auto h = find_halfedge(from, to);
        if (h.is_valid() && !is_joint(edge_handle(h))) mark_feature(edge_handle(h), EdgeRole::feature);
      });
    });
  for (const VertexHandle v : vertices())
    if (is_contact(v)) on_feature_[v.idx()] = 1;
}

// Whether sheets meet in the vertex, and this one not along an edge.
bool FeatureMesh::is_contact(VertexHandle v) const {
  if (!has_copies(v)) return false;
  return std::ranges::none_of(ve_range(v), [&](EdgeHandle e) { return is_joint(e); });
}

void FeatureMesh::mark_feature(EdgeHandle e, EdgeRole role) {
  edge_role_[e.idx()] = role;
  on_feature_[to_vertex_handle(halfedge_handle(e, 0)).idx()] = 1;
  on_feature_[to_vertex_handle(halfedge_handle(e, 1)).idx()] = 1;
}

void FeatureMesh::forget_features(std::span<const EdgeHandle> edges) {
  for (const EdgeHandle e : edges) edge_role_[e.idx()] = EdgeRole::none;
  for (const EdgeHandle e : edges)
    for (const unsigned end : {0u, 1u}) {
      const VertexHandle v = to_vertex_handle(halfedge_handle(e, end));
      on_feature_[v.idx()] = std::ranges::any_of(ve_range(v), [&](EdgeHandle other) { return is_feature(other); });
      if (!is_on_feature(v) || !is_corner(v)) vertex_role_[v.idx()] = VertexRole::removable;
    }
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
  std::vector<Vec3> directions;
  std::vector<std::int32_t> joint_ends;  // which several copies have
  bool is_touched = false;
  for_each_copy(v, [&](VertexHandle copy) {
    is_touched = is_touched || is_contact(copy);
    for (const HalfedgeHandle h : voh_range(copy)) {
      if (!is_feature(edge_handle(h))) continue;
      if (is_joint(edge_handle(h))) {
        const std::int32_t end = place(to_vertex_handle(h));
        if (std::ranges::find(joint_ends, end) != joint_ends.end()) continue;
        joint_ends.push_back(end);
      }
      directions.push_back(unit(position(to_vertex_handle(h)) - position(v)));
    }
  });
  return is_touched || directions.size() != 2 || -dot(directions[0], directions[1]) < corner_cosine_;
}

std::vector<FeatureMesh::HalfedgeHandle> FeatureMesh::copies(HalfedgeHandle h) const {
  std::vector<HalfedgeHandle> result{h};
  if (!is_joint(edge_handle(h))) return result;
  const std::int32_t end = place(to_vertex_handle(h));
  for_each_copy(from_vertex_handle(h), [&](VertexHandle from) {
    for (const HalfedgeHandle other : voh_range(from))
      if (other != h && is_joint(edge_handle(other)) && place(to_vertex_handle(other)) == end) result.push_back(other);
  });
  return result;
}

FeatureMesh::VertexHandle FeatureMesh::add_removable(const Vec3& p, bool on_feature) {
  const VertexHandle v = add_vertex(to_open_mesh(p));
  resize_attributes();
  on_feature_[v.idx()] = on_feature;
  return v;
}

FeatureMesh::VertexHandle FeatureMesh::split_edge_at(EdgeHandle e, const Vec3& p) {
  const std::vector<HalfedgeHandle> parts = copies(halfedge_handle(e, 0));
  const VertexHandle first = split_one_edge_at(e, p);
  for (const HalfedgeHandle h : std::span(parts).subspan(1)) join_copies(first, split_one_edge_at(edge_handle(h), p));
  return first;
}

FeatureMesh::VertexHandle FeatureMesh::split_one_edge_at(EdgeHandle e, const Vec3& p) {
  HalfedgeHandle h = halfedge_handle(e, 0);
  if (is_boundary(h)) h = opposite_halfedge_handle(h);
  const HalfedgeHandle twin = opposite_halfedge_handle(h);
  const VertexHandle ends[2] = {to_vertex_handle(h), from_vertex_handle(h)};
  const VertexHandle across = to_vertex_handle(next_halfedge_handle(h));
  const std::int32_t source_here = source(face_handle(h));
  const std::int32_t source_there = is_boundary(twin) ? source_here : source(face_handle(twin));
  const EdgeRole role = edge_role_[e.idx()];
  const VertexHandle v = add_removable(p, is_feature(e));
  split(e, v);
  resize_attributes();
  for (const HalfedgeHandle out : voh_range(v)) {
    const VertexHandle end = to_vertex_handle(out);
    edge_role_[edge_handle(out).idx()] = end == ends[0] || end == ends[1] ? role : EdgeRole::none;
    if (is_boundary(out)) continue;
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

void FeatureMesh::flip_behind_corner(HalfedgeHandle h) {
  const EdgeHandle e = edge_handle(h);
  const HalfedgeHandle next = next_halfedge_handle(h);
  const FaceHandle corner_face = face_handle(h), other = face_handle(opposite_halfedge_handle(h));
  const EdgeHandle sides[] = {edge_handle(next), edge_handle(next_halfedge_handle(next))};
  const VertexHandle corner = to_vertex_handle(next);
  const EdgeRole role = std::exchange(edge_role_[e.idx()], EdgeRole::none);
  flip(e);
  source_[corner_face.idx()] = source_[other.idx()];
  if (role == EdgeRole::none) return;
  for (const EdgeHandle side : sides) edge_role_[side.idx()] = std::max(edge_role_[side.idx()], role);
  on_feature_[corner.idx()] = 1;
}

// The same as OpenMesh's collapse(), which Debian builds with its checks: these look up the type of each property at
// each access, and took a twentieth of tetmesh's time on a large scan.
void FeatureMesh::join_ends(HalfedgeHandle h) {
  const HalfedgeHandle twin = opposite_halfedge_handle(h), next = next_halfedge_handle(h);
  const HalfedgeHandle next_of_twin = next_halfedge_handle(twin);
  const VertexHandle stays = to_vertex_handle(h), goes = to_vertex_handle(twin);
  for (HalfedgeHandle out = h;;) {
    set_vertex_handle(opposite_halfedge_handle(out), stays);
    out = next_halfedge_handle(opposite_halfedge_handle(out));
    if (out == h) break;
  }
  set_next_halfedge_handle(prev_halfedge_handle(h), next);
  set_next_halfedge_handle(prev_halfedge_handle(twin), next_of_twin);
  if (face_handle(h).is_valid()) set_halfedge_handle(face_handle(h), next);
  if (face_handle(twin).is_valid()) set_halfedge_handle(face_handle(twin), next_of_twin);
  if (halfedge_handle(stays) == twin) set_halfedge_handle(stays, next);
  begin_at_border(stays);
  set_isolated(goes);
  status(edge_handle(h)).set_deleted(true);
  status(goes).set_deleted(true);
  if (next_halfedge_handle(next_halfedge_handle(next)) == next) remove_loop(next_halfedge_handle(next));
  if (next_halfedge_handle(next_halfedge_handle(next_of_twin)) == next_of_twin) remove_loop(next_of_twin);
}

// Takes out a face of two edges; one of them stays.
void FeatureMesh::remove_loop(HalfedgeHandle h) {
  const HalfedgeHandle stays = next_halfedge_handle(h);
  const HalfedgeHandle beyond = opposite_halfedge_handle(h), beside = opposite_halfedge_handle(stays);
  const VertexHandle end = to_vertex_handle(h), start = to_vertex_handle(stays);
  const FaceHandle inner = face_handle(h), outer = face_handle(beyond);
  set_next_halfedge_handle(stays, next_halfedge_handle(beyond));
  set_next_halfedge_handle(prev_halfedge_handle(beyond), stays);
  if (outer.is_valid())
    set_face_handle(stays, outer);
  else
    set_boundary(stays);
  set_halfedge_handle(end, stays);
  begin_at_border(end);
  set_halfedge_handle(start, beside);
  begin_at_border(start);
  if (outer.is_valid() && halfedge_handle(outer) == beyond) set_halfedge_handle(outer, stays);
  if (inner.is_valid()) status(inner).set_deleted(true);
  status(edge_handle(h)).set_deleted(true);
}

// As OpenMesh wants it: the half-edge of a vertex on a border is on the border.
void FeatureMesh::begin_at_border(VertexHandle v) {
  const HalfedgeHandle first = halfedge_handle(v);
  HalfedgeHandle h = first;
  do {
    if (is_boundary(h)) return set_halfedge_handle(v, h);
    h = next_halfedge_handle(opposite_halfedge_handle(h));
  } while (h != first);
}

// Two pairs of edges become one edge each; at a border it is one pair. The edge that survives is a feature if one of
// its pair was.
void FeatureMesh::collapse_edge(HalfedgeHandle h) {
  const VertexHandle end = to_vertex_handle(h);
  std::array<std::pair<VertexHandle, EdgeRole>, 2> sides;
  std::size_t count = 0;
  for (const HalfedgeHandle side : {h, opposite_halfedge_handle(h)}) {
    if (is_boundary(side)) continue;
    const HalfedgeHandle next = next_halfedge_handle(side), last = next_halfedge_handle(next);
    sides[count++] = {to_vertex_handle(next),
                      std::max(edge_role_[edge_handle(next).idx()], edge_role_[edge_handle(last).idx()])};
  }
  join_ends(h);
  for (const auto& [across, role] : std::span(sides).first(count))
    edge_role_[edge_handle(find_halfedge(end, across)).idx()] = role;
}

}  // namespace hexpipe::tetmesh::surface
