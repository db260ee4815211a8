// Half-edge collapses in rounds; in each round no two of them touch, so that triangles grow everywhere alike. A face
// keeps a list of the vertices that went and are nearest to it, so that each is measured again whenever the face
// changes (R. Klein, G. Liebich, W. Strasser: Mesh reduction with error control, 1996, with vertices in place of the
// distance between surfaces). A sum of the distances of all steps would grow with a scan's noise in each round, and
// stop early. A round takes each list along once, so the time is that of the vertices times the rounds.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/mesh/defaults.hpp"
#include "common/mesh/joined_sets.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// New edges turn by at most this share of the feature angle, so that none becomes a feature.
constexpr double sharpest = 0.75;
// Rounds end when one removes less than this share of the vertices.
constexpr double least_gain = 0.01;
// Sharp edges that together are shorter than this share of the longest edge are noise, or too small to be seen.
constexpr double speck = 0.5;

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
        first_gone_(mesh.n_faces(), no_index),
        next_gone_(mesh.n_vertices(), no_index),
        limits_(mesh.n_vertices()),
        touched_(mesh.n_vertices()),
        stuck_(mesh.n_vertices()) {
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
        if (touched_[v.idx()] == round || stuck_[v.idx()] || !remove(v, round)) left.push_back(v);
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
    FeatureMesh::VertexHandle beyond;    // the third corner of the face across it; `from` at a border
    Vec3 outer_normal;
    bool outer_is_sharp = false;  // a feature, or a border
    bool goes = false;
    Vec3 normal;  // of the new face
  };
  struct Choice {
    double shape;
    FeatureMesh::HalfedgeHandle collapse;
  };

  // The normal of all faces around the vertex. At a vertex that noise has put far out each face is turned from it.
  const Vec3& normal_around() {
    if (!normal_around_) {
      normal_around_.emplace();
      for (const Wedge& wedge : wedges_) *normal_around_ += mesh_.area_normal(wedge.face);
      normal_around_ = unit(*normal_around_);
    }
    return *normal_around_;
  }

  // Both are looked up when a vertex is first tried, not in each round.
  struct Limits {
    double tolerance = 0, longest = 0;
  };

  bool remove(FeatureMesh::VertexHandle v, int round) {
    gather(v);
    const Limits limits = limits_at(v);
    choices_.clear();
    for (const auto h : mesh_.voh_range(v))
      if (const double shape = shape_after(h, limits.longest); shape > least_shape) choices_.push_back({shape, h});
    std::ranges::stable_sort(choices_, std::ranges::greater(), &Choice::shape);
    for (const Choice& choice : choices_) {
      const auto end = mesh_.to_vertex_handle(choice.collapse);
      if (!turns_little_after(end) || !is_smooth_after() || !is_manifold_after(end) || !find_new_faces(end)) continue;
      mesh_.collapse_edge(choice.collapse);
      touched_[end.idx()] = round;
      for (const Wedge& wedge : wedges_) {
        touched_[wedge.from.idx()] = round;
        stuck_[wedge.from.idx()] = stuck_[wedge.beyond.idx()] = false;
        if (!wedge.goes) normals_[wedge.face.idx()] = wedge.normal;
      }
      hand_over();
      return true;
    }
    stuck_[v.idx()] = true;
    return false;
  }

  Limits limits_at(FeatureMesh::VertexHandle v) {
    Limits& limits = limits_[v.idx()];
    if (limits.longest == 0) limits = {tolerance_.at(mesh_.position(v)), longest_.at(mesh_.position(v))};
    return limits;
  }

  void gather(FeatureMesh::VertexHandle v) {
    wedges_.clear();
    gone_.assign(1, v.idx());
    normal_around_.reset();
    for (const auto h : mesh_.voh_range(v)) {
      Wedge wedge;
      wedge.face = mesh_.face_handle(h);
      wedge.from = mesh_.to_vertex_handle(h);
      const auto outer = mesh_.next_halfedge_handle(h), twin = mesh_.opposite_halfedge_handle(outer);
      wedge.to = mesh_.to_vertex_handle(outer);
      wedge.outer_is_sharp = mesh_.is_boundary(twin) || mesh_.is_feature(mesh_.edge_handle(outer));
      wedge.beyond = mesh_.is_boundary(twin) ? wedge.from : mesh_.to_vertex_handle(mesh_.next_halfedge_handle(twin));
      if (!mesh_.is_boundary(twin)) wedge.outer_normal = normals_[mesh_.face_handle(twin).idx()];
      for (std::int32_t gone = first_gone_[wedge.face.idx()]; gone != no_index; gone = next_gone_[gone])
        gone_.push_back(gone);
      wedges_.push_back(wedge);
    }
  }

  // The least shape of the new faces; negative if one has too long an edge.
  double shape_after(FeatureMesh::HalfedgeHandle collapse, double longest) {
    const auto end = mesh_.to_vertex_handle(collapse);
    const Vec3 at = mesh_.position(end);
    double least = std::numeric_limits<double>::max();
    for (const Wedge& wedge : wedges_) {
      if (wedge.from == end || wedge.to == end) continue;
      const std::array<Vec3, 3> corners{at, mesh_.position(wedge.from), mesh_.position(wedge.to)};
      if (norm_squared(corners[1] - at) > longest * longest) return -1;
      least = std::min(least, shape_of(corners, cross(corners[1] - at, corners[2] - at)));
      if (least <= least_shape) return -1;
    }
    return least;
  }

  // Whether no new face turns too far from the one that it replaces. Sets which wedges go, and the normals of the
  // others.
  bool turns_little_after(FeatureMesh::VertexHandle end) {
    const Vec3 at = mesh_.position(end);
    for (Wedge& wedge : wedges_) {
      wedge.goes = wedge.from == end || wedge.to == end;
      if (wedge.goes) continue;
      wedge.normal = unit(cross(mesh_.position(wedge.from) - at, mesh_.position(wedge.to) - at));
      const bool turns = dot(wedge.normal, normals_[wedge.face.idx()]) < least_cosine_;
      if (turns && dot(wedge.normal, normal_around()) < least_cosine_) return false;
    }
    return true;
  }

  // Whether the vertex that goes and the end have no neighbour in common but the two across their edge. OpenMesh's
  // is_collapse_ok() asks for more only at borders, where no vertex goes, and marks the vertices around both.
  bool is_manifold_after(FeatureMesh::VertexHandle end) const {
    FeatureMesh::VertexHandle left, right;
    for (const Wedge& wedge : wedges_) {
      if (wedge.to == end) left = wedge.from;
      if (wedge.from == end) right = wedge.to;
    }
    if (left == right) return false;
    for (const auto h : mesh_.voh_range(end)) {
      const auto other = mesh_.to_vertex_handle(h);
      if (other == left || other == right) continue;
      for (const Wedge& wedge : wedges_)
        if (wedge.from == other) return false;
    }
    return true;
  }

  // The new face nearest to each vertex that is gone then; false if one is further than its tolerance from all.
  bool find_new_faces(FeatureMesh::VertexHandle end) {
    faces_.clear();
    for (const Wedge& wedge : wedges_)
      if (!wedge.goes) faces_.emplace_back(mesh_.position(end), mesh_.position(wedge.from), mesh_.position(wedge.to));
    new_face_.clear();
    for (const std::int32_t gone : gone_) {
      const FeatureMesh::VertexHandle v(gone);
      const Vec3 place = mesh_.position(v);
      const double tolerance = limits_at(v).tolerance;
      double least = tolerance * tolerance;
      std::size_t nearest = faces_.size();
      for (std::size_t i = 0; i < faces_.size(); ++i) {
        const double squared = faces_[i].squared(place);
        if (squared <= least) least = squared, nearest = i;
      }
      if (nearest == faces_.size()) return false;
      new_face_.push_back(nearest);
    }
    return true;
  }

  void hand_over() {
    staying_.clear();
    for (const Wedge& wedge : wedges_)
      if (!wedge.goes) staying_.push_back(wedge.face.idx());
    for (const int face : staying_) first_gone_[face] = no_index;
    for (std::size_t i = 0; i < gone_.size(); ++i) {
      std::int32_t& first = first_gone_[staying_[new_face_[i]]];
      next_gone_[gone_[i]] = first;
      first = gone_[i];
    }
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
  std::vector<Vec3> normals_;  // by face, of length 1
  // By face, the first vertex that is gone and nearest to it; by vertex, the next one of its list.
  std::vector<std::int32_t> first_gone_, next_gone_;
  std::vector<Limits> limits_;         // by vertex
  std::vector<std::int32_t> touched_;  // by vertex: the round in which it was last at a collapse
  // By vertex: it could not be removed, and no collapse has changed the faces around it or beside these since then.
  std::vector<bool> stuck_;
  std::vector<Wedge> wedges_;
  std::vector<Choice> choices_;
  std::optional<Vec3> normal_around_;
  // The vertices in the lists of the wedges' faces, and the one that goes; for each, the number of its new face.
  std::vector<std::int32_t> gone_;
  std::vector<std::size_t> new_face_;
  std::vector<geometry::TriangleDistance> faces_;  // the new ones
  std::vector<int> staying_;
};

// Sharp edges that are connected with so few others that noise may have made them. A scan with noise has thousands, and
// as features each would keep its vertices.
std::vector<FeatureMesh::EdgeHandle> specks(const FeatureMesh& mesh, const solid::Surface& surface,
                                            const sizing::SizeField& longest) {
  std::vector<FeatureMesh::EdgeHandle> result;
  if (!surface.curves.empty()) return result;
  const auto start = [&](FeatureMesh::EdgeHandle e) { return mesh.to_vertex_handle(mesh.halfedge_handle(e, 0)); };
  const auto end = [&](FeatureMesh::EdgeHandle e) { return mesh.to_vertex_handle(mesh.halfedge_handle(e, 1)); };
  JoinedSets sets(mesh.n_vertices());
  for (const auto e : mesh.edges())
    if (mesh.is_feature(e)) sets.join(start(e).idx(), end(e).idx());
  std::vector<double> length(mesh.n_vertices());  // by the number of a set
  for (const auto e : mesh.edges()) {
    if (!mesh.is_feature(e)) continue;
    const bool is_sharp_only = !mesh.is_boundary(e) && !mesh.has_copies(start(e)) && !mesh.has_copies(end(e)) &&
                               surface.tags[mesh.source(mesh.face_handle(mesh.halfedge_handle(e, 0)))] ==
                                   surface.tags[mesh.source(mesh.face_handle(mesh.halfedge_handle(e, 1)))];
    length[sets.of(start(e).idx())] +=
        is_sharp_only ? norm(mesh.position(start(e)) - mesh.position(end(e))) : std::numeric_limits<double>::infinity();
  }
  // A set goes or stays as a whole: it is measured where the edges may be shortest.
  const sizing::SizeField longest_speck = speck * longest;
  std::vector<bool> stays(mesh.n_vertices());  // by the number of a set
  for (const auto e : mesh.edges()) {
    if (!mesh.is_feature(e)) continue;
    const std::int32_t set = sets.of(start(e).idx());
    stays[set] = stays[set] || !longest_speck.is_at_least(length[set], mesh.position(start(e))) ||
                 !longest_speck.is_at_least(length[set], mesh.position(end(e)));
  }
  for (const auto e : mesh.edges())
    if (mesh.is_feature(e) && !stays[sets.of(start(e).idx())]) result.push_back(e);
  return result;
}

// The ends of curves are on features, which stay.
void add_curves(const solid::Surface& surface, const FeatureMesh& mesh, solid::Surface& thinned) {
  if (surface.curves.empty()) return;
  thinned.curves = surface.curves;
  thinned.curve_tags = surface.curve_tags;
  formats::renumber_curves(thinned, mesh.point_numbers());
}

}  // namespace

solid::Surface thin_out(const solid::Surface& surface, double feature_angle, const sizing::SizeField& tolerance,
                        const sizing::SizeField& longest) {
  FeatureMesh mesh(surface, feature_angle);
  if (!mesh.is_manifold()) return surface;
  mesh.forget_features(specks(mesh, surface, longest));
  Thinner(mesh, feature_angle, tolerance, longest).thin();
  solid::Surface thinned = mesh.to_surface(surface);
  add_curves(surface, mesh, thinned);
  return thinned;
}

}  // namespace hexpipe::tetmesh::surface
