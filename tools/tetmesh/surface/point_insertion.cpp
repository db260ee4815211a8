#include "tools/tetmesh/surface/remesh_steps.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe::tetmesh::surface {
namespace {

class PointInserter {
 public:
  PointInserter(FeatureMesh& mesh, const sizing::SizeField& snap)
      : mesh_(mesh), snap_(snap), cut_from_(mesh.n_faces()) {
    for (std::size_t f = 0; f < cut_from_.size(); ++f) cut_from_[f] = static_cast<std::int32_t>(f);
  }

  void insert(const SurfacePoint& point) {
    const Vec3& p = point.position;
    const double snap = snap_.at(p);
    const auto face = part_around(point);
    for (const auto v : mesh_.corners(face))
      if (norm(mesh_.position(v) - p) < snap) return become(v, p);
    const auto nearest = nearest_edge(face, p);
    const auto from = mesh_.position(mesh_.from_vertex_handle(nearest)),
               to = mesh_.position(mesh_.to_vertex_handle(nearest));
    const double t = dot(p - from, to - from) / norm_squared(to - from);
    const Vec3 foot = from + t * (to - from);
    if (norm(foot - p) >= snap) {
      const auto v = mesh_.split_face_at(face, p);
      mesh_.keep(v);
      inherit(v, cut_from_[face.idx()]);
    } else if (!mesh_.is_feature(mesh_.edge_handle(nearest)) && t > 0 && t < 1) {
      become(split_edge(nearest, foot), p);
    }
  }

 private:
  using Face = OpenMesh::FaceHandle;
  using HalfEdgeHandle = OpenMesh::HalfedgeHandle;

  // The signed distance from an edge's line, positive inside the face.
  double inside(HalfEdgeHandle h, const Vec3& normal, const Vec3& p) const {
    const Vec3 from = mesh_.position(mesh_.from_vertex_handle(h)),
               along = mesh_.position(mesh_.to_vertex_handle(h)) - from;
    return det(normal, along, p - from) / norm(along);
  }

  HalfEdgeHandle nearest_edge(Face f, const Vec3& p) const {
    const Vec3 normal = unit(mesh_.area_normal(f));
    HalfEdgeHandle nearest;
    double least = std::numeric_limits<double>::max();
    for (const auto h : mesh_.fh_range(f))
      if (const double distance = inside(h, normal, p); distance < least) {
        least = distance;
        nearest = h;
      }
    return nearest;
  }

  double depth(Face f, const Vec3& p) const {
    const Vec3 area = mesh_.area_normal(f), normal = area * (1 / std::max(norm(area), 1e-300));
    double least = std::numeric_limits<double>::max();
    for (const auto h : mesh_.fh_range(f)) least = std::min(least, inside(h, normal, p));
    return least;
  }

  // Among the fragments of the point's face, the one in which the point lies deepest.
  Face part_around(const SurfacePoint& point) {
    parts_.assign(1, mesh_.face_handle(static_cast<unsigned>(point.triangle)));
    Face best = parts_[0];
    double most = depth(best, point.position);
    for (std::size_t i = 0; i < parts_.size() && most < 0; ++i)
      for (const Face g : mesh_.ff_range(parts_[i])) {
        if (cut_from_[g.idx()] != point.triangle || std::ranges::find(parts_, g) != parts_.end()) continue;
        parts_.push_back(g);
        if (const double d = depth(g, point.position); d > most) {
          most = d;
          best = g;
        }
      }
    return best;
  }

  OpenMesh::VertexHandle split_edge(HalfEdgeHandle h, const Vec3& p) {
    const std::int32_t here = cut_from_[mesh_.face_handle(h).idx()];
    const std::int32_t there = cut_from_[mesh_.face_handle(mesh_.opposite_halfedge_handle(h)).idx()];
    const auto across = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
    const auto v = mesh_.split_edge_at(mesh_.edge_handle(h), p);
    cut_from_.resize(mesh_.n_faces());
    for (const auto out : mesh_.voh_range(v)) {
      const bool is_here =
          mesh_.to_vertex_handle(out) == across || mesh_.to_vertex_handle(mesh_.next_halfedge_handle(out)) == across;
      cut_from_[mesh_.face_handle(out).idx()] = is_here ? here : there;
    }
    return v;
  }

  // Moves the vertex to a point near it if that leaves the surface as it is. Otherwise the vertex stays and stands for
  // the point.
  void become(OpenMesh::VertexHandle v, const Vec3& p) {
    if (!mesh_.is_kept(v) && !mesh_.is_on_feature(v) && stays_flat_with(v, p)) mesh_.set_point(v, to_open_mesh(p));
    mesh_.keep(v);
  }

  // Whether the faces at v lie in one plane, and still do with v at p, none of them turned over.
  bool stays_flat_with(OpenMesh::VertexHandle v, const Vec3& p) const {
    if (!mesh_.is_flat_around(v)) return false;
    const Vec3 normal = unit(mesh_.area_normal(*mesh_.cvf_begin(v)));
    for (const auto h : mesh_.voh_range(v)) {
      const Vec3 to = mesh_.position(mesh_.to_vertex_handle(h)),
                 next = mesh_.position(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)));
      const Vec3 area = cross(to - p, next - p);
      const double along = dot(area, normal);
      if (along <= 0 || norm(area - along * normal) > plane_tolerance * along) return false;
    }
    return true;
  }

  void inherit(OpenMesh::VertexHandle v, std::int32_t face) {
    cut_from_.resize(mesh_.n_faces());
    for (const Face f : mesh_.vf_range(v)) cut_from_[f.idx()] = face;
  }

  FeatureMesh& mesh_;
  const sizing::SizeField& snap_;
  std::vector<std::int32_t> cut_from_;  // by face: the original face that it is a fragment of
  std::vector<Face> parts_;
};

}  // namespace

void insert_points(FeatureMesh& mesh, std::span<const SurfacePoint> points, const sizing::SizeField& snap) {
  PointInserter inserter(mesh, snap);
  for (const SurfacePoint& point : points) inserter.insert(point);
}

}  // namespace hexpipe::tetmesh::surface
