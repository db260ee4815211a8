// Half-edge collapses in rounds; in each round no two of them touch, so that triangles grow everywhere alike. A face
// knows how far the original surface may be from it: each collapse adds the distance of the vertex that goes. The sum
// grows slowly, because a round halves the vertices or so.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "common/mesh/feature_angle.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// New edges turn by at most this share of the feature angle, so that none becomes a feature.
constexpr double sharpest = 0.75;
// Rounds end when one removes less than this share of the vertices.
constexpr double least_gain = 0.01;

class Thinner {
 public:
  // A collapse makes triangles of at least this shape (1 is equilateral).
  static constexpr double least_shape = 0.1;
  static constexpr int most_rounds = 40;

  Thinner(FeatureMesh& mesh, double feature_angle, const sizing::SizeField& tolerance, const sizing::SizeField& longest)
      : mesh_(mesh),
        least_cosine_(cosine_of_degrees(sharpest * feature_angle)),
        tolerance_(tolerance),
        longest_(longest),
        error_(mesh.n_faces()),
        touched_(mesh.n_vertices()) {
    for (const FeatureMesh::FaceHandle f : mesh.faces()) normals_.push_back(unit(mesh.area_normal(f)));
  }

  void thin() {
    std::vector<FeatureMesh::VertexHandle> waiting;
    for (const auto v : mesh_.vertices())
      if (!mesh_.is_on_feature(v) && !mesh_.is_kept(v) && !mesh_.has_copies(v) && !mesh_.is_boundary(v))
        waiting.push_back(v);
    std::vector<FeatureMesh::VertexHandle> left;
    for (int round = 1; round <= most_rounds; ++round) {
      left.clear();
      for (const auto v : waiting)
        if (touched_[v.idx()] == round || !remove(v, round)) left.push_back(v);
      const auto gone = static_cast<double>(waiting.size() - left.size());
      if (gone < least_gain * static_cast<double>(waiting.size())) break;
      std::swap(waiting, left);
    }
  }

 private:
  // A face at the vertex that goes, in their order around it, and the face across its outer edge.
  struct Wedge {
    FeatureMesh::FaceHandle face;
    FeatureMesh::VertexHandle from, to;  // of the outer edge
    Vec3 outer_normal;
    bool outer_is_sharp = false;  // a feature, or a border
    bool goes = false;
    Vec3 normal;  // of the new face
  };
  struct Choice {
    double shape;
    FeatureMesh::HalfedgeHandle collapse;
  };

  bool remove(FeatureMesh::VertexHandle v, int round) {
    gather(v);
    const Vec3 place = mesh_.position(v);
    const double tolerance = tolerance_.at(place), longest = longest_.at(place);
    if (!(error_around_ < tolerance)) return false;
    choices_.clear();
    for (const auto h : mesh_.voh_range(v))
      if (const double shape = shape_after(h, longest); shape > least_shape) choices_.push_back({shape, h});
    std::ranges::stable_sort(choices_, std::ranges::greater(), &Choice::shape);
    for (const Choice& choice : choices_) {
      const auto end = mesh_.to_vertex_handle(choice.collapse);
      const double error = error_around_ + distance_after(place, mesh_.position(end), end);
      if (error > tolerance || !mesh_.is_collapse_ok(choice.collapse)) continue;
      shape_after(choice.collapse, longest);  // sets the normals
      if (!is_smooth_after()) continue;
      mesh_.collapse_edge(choice.collapse);
      touched_[end.idx()] = round;
      for (const Wedge& wedge : wedges_) {
        touched_[wedge.from.idx()] = round;
        if (wedge.goes) continue;
        error_[wedge.face.idx()] = error;
        normals_[wedge.face.idx()] = wedge.normal;
      }
      return true;
    }
    return false;
  }

  void gather(FeatureMesh::VertexHandle v) {
    wedges_.clear();
    error_around_ = 0;
    for (const auto h : mesh_.voh_range(v)) {
      Wedge wedge;
      wedge.face = mesh_.face_handle(h);
      wedge.from = mesh_.to_vertex_handle(h);
      const auto outer = mesh_.next_halfedge_handle(h), twin = mesh_.opposite_halfedge_handle(outer);
      wedge.to = mesh_.to_vertex_handle(outer);
      wedge.outer_is_sharp = mesh_.is_boundary(twin) || mesh_.is_feature(mesh_.edge_handle(outer));
      if (!mesh_.is_boundary(twin)) wedge.outer_normal = normals_[mesh_.face_handle(twin).idx()];
      error_around_ = std::max(error_around_, error_[wedge.face.idx()]);
      wedges_.push_back(wedge);
    }
  }

  // The least shape of the new faces; negative if one turns too far or has too long an edge. Sets the wedges' normals.
  double shape_after(FeatureMesh::HalfedgeHandle collapse, double longest) {
    const auto end = mesh_.to_vertex_handle(collapse);
    const Vec3 at = mesh_.position(end);
    double least = std::numeric_limits<double>::max();
    for (Wedge& wedge : wedges_) {
      wedge.goes = wedge.from == end || wedge.to == end;
      if (wedge.goes) continue;
      const std::array<Vec3, 3> corners{at, mesh_.position(wedge.from), mesh_.position(wedge.to)};
      const Vec3 normal = cross(corners[1] - at, corners[2] - at);
      if (norm_squared(corners[1] - at) > longest * longest) return -1;
      least = std::min(least, shape_of(corners, normal));
      if (least <= least_shape) return -1;
      wedge.normal = unit(normal);
      if (dot(wedge.normal, normals_[wedge.face.idx()]) < least_cosine_) return -1;
    }
    return least;
  }

  double distance_after(const Vec3& p, const Vec3& at, FeatureMesh::VertexHandle end) const {
    double least = std::numeric_limits<double>::max();
    for (const Wedge& wedge : wedges_) {
      if (wedge.from == end || wedge.to == end) continue;
      const geometry::TriangleDistance face(at, mesh_.position(wedge.from), mesh_.position(wedge.to));
      least = std::min(least, face.squared(p));
    }
    return std::sqrt(least);
  }

  // Whether no edge of the new faces turns too far.
  bool is_smooth_after() const {
    for (std::size_t i = 0; i < wedges_.size(); ++i) {
      const Wedge &here = wedges_[i], &next = wedges_[(i + 1) % wedges_.size()];
      if (!here.goes && !here.outer_is_sharp && dot(here.normal, here.outer_normal) < least_cosine_) return false;
      if (!here.goes && !next.goes && dot(here.normal, next.normal) < least_cosine_) return false;
      // The outer edge of a face that goes becomes an edge of its neighbour.
      const Wedge &stays = here.goes ? next : here, &gone = here.goes ? here : next;
      if (here.goes != next.goes && !gone.outer_is_sharp && dot(stays.normal, gone.outer_normal) < least_cosine_)
        return false;
    }
    return true;
  }

  FeatureMesh& mesh_;
  double least_cosine_;
  const sizing::SizeField &tolerance_, &longest_;
  std::vector<double> error_;          // by face
  std::vector<Vec3> normals_;          // by face, of length 1
  std::vector<std::int32_t> touched_;  // by vertex: the round in which it was last at a collapse
  std::vector<Wedge> wedges_;
  std::vector<Choice> choices_;
  double error_around_ = 0;
};

// The ends of curves are on features, which stay.
void add_curves(const solid::Surface& surface, const FeatureMesh& mesh, solid::Surface& thinned) {
  if (surface.curves.empty()) return;
  const std::vector<Vertex> number = mesh.point_numbers();
  for (const auto& [from, to] : surface.curves) thinned.curves.push_back({number[from], number[to]});
  thinned.curve_tags = surface.curve_tags;
}

}  // namespace

solid::Surface thin_out(const solid::Surface& surface, double feature_angle, const sizing::SizeField& tolerance,
                        const sizing::SizeField& longest) {
  FeatureMesh mesh(surface, feature_angle);
  if (!mesh.is_manifold()) return surface;
  Thinner(mesh, feature_angle, tolerance, longest).thin();
  solid::Surface thinned = mesh.to_surface(surface);
  add_curves(surface, mesh, thinned);
  return thinned;
}

}  // namespace hexpipe::tetmesh::surface
