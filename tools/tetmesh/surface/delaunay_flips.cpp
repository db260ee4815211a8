#include "tools/tetmesh/surface/delaunay_flips.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <utility>

#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// With a positive excess, rounding cannot flip the diagonal of a square back and forth.
constexpr double least_excess = 1e-9;

// The cosine and the sine of the angle at p, times the lengths of its sides.
struct Angle {
  double cosine, sine;
  Angle(const Vec3& p, const Vec3& a, const Vec3& b) : cosine(dot(a - p, b - p)), sine(norm(cross(a - p, b - p))) {}
};

// The height of a cap is at most this share of its longest edge; from both ends of that, its foot is as many heights
// away as the second number says.
constexpr double flattest = 0.05, least_foot = 2;
// Flips make triangles better by this factor, and by more than what rounding makes of a triangle without area.
constexpr double least_gain = 1.01, least_shape = 1e-9;
// The least cosine of the angle by which a triangle turns.
constexpr double least_turn_cosine = 0.5;

// The flattest first.
class CapFlipper {
 public:
  CapFlipper(FeatureMesh& mesh, const solid::Surface& surface, const sizing::SizeField& nearest,
             const std::function<bool(HalfEdgeH, double)>& allow)
      : mesh_(mesh), surface_(surface), nearest_(nearest), allow_(allow), moved_(mesh.n_edges()) {
    if (surface.names.surfaces.empty()) return;
    for (const FaceH f : mesh.faces()) ++triangles_of_[tag_of(f)];
  }

  std::vector<FlippedCap> run() {
    for (const FaceH f : mesh_.faces()) offer(f);
    while (!queue_.empty()) {
      const auto [height, number] = queue_.top();
      queue_.pop();
      const HalfEdgeH h(number);
      if (height_of_cap(h) == height && can_flip(h, height)) flip(h, height);
    }
    return std::move(flipped_);
  }

 private:
  using Entry = std::pair<double, int>;  // the height of a cap, and the number of its half-edge

  std::int32_t tag_of(FaceH f) const { return surface_.tags[mesh_.source(f)]; }

  void offer(FaceH f) {
    for (const HalfEdgeH h : mesh_.fh_range(f))
      if (const double height = height_of_cap(h); height >= 0) queue_.push({height, h.idx()});
  }

  // Negative where the half-edge is not the longest one of a cap.
  double height_of_cap(HalfEdgeH h) const {
    if (!mesh_.face_handle(h).is_valid()) return -1;
    const HalfEdgeH next = mesh_.next_halfedge_handle(h);
    // Other edges count only between features, where they would be in the way of these.
    const std::array corners{mesh_.from_vertex_handle(h), mesh_.to_vertex_handle(h), mesh_.to_vertex_handle(next)};
    if (!mesh_.is_feature(mesh_.edge_handle(h)) &&
        !std::ranges::all_of(corners, [&](VertexH v) { return mesh_.is_on_feature(v); }))
      return -1;
    const Vec3 a = mesh_.position(corners[0]), b = mesh_.position(corners[1]), corner = mesh_.position(corners[2]);
    const double length = norm(b - a), height = norm(cross(b - a, corner - a)) / length,
                 foot = dot(corner - a, b - a) / length;
    const bool is_cap = std::min(foot, length - foot) >= least_foot * height && height <= flattest * length &&
                        nearest_.is_at_least(height + moved_[mesh_.edge_handle(h).idx()], corner);
    return is_cap ? height : -1;
  }

  bool can_flip(HalfEdgeH h, double height) const {
    const EdgeH e = mesh_.edge_handle(h);
    const HalfEdgeH twin = mesh_.opposite_halfedge_handle(h);
    if (mesh_.is_joint(e) || mesh_.is_boundary(e) || !mesh_.is_flip_ok(e)) return false;
    const FaceH f = mesh_.face_handle(h), g = mesh_.face_handle(twin);
    if (mesh_.is_held(f) || mesh_.is_held(g)) return false;
    const std::int32_t tag = tag_of(f);
    if (tag != tag_of(g) && surface_.names.surfaces.contains(tag) && triangles_of_.at(tag) == 1) return false;
    const VertexH corner_vertex = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)),
                  across_vertex = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(twin));
    // Another sheet may have an edge between their places.
    if (mesh_.has_copies(corner_vertex) && mesh_.has_copies(across_vertex)) return false;
    const Vec3 a = mesh_.position(mesh_.from_vertex_handle(h)), b = mesh_.position(mesh_.to_vertex_handle(h)),
               corner = mesh_.position(corner_vertex), across = mesh_.position(across_vertex);
    const Vec3 before = mesh_.area_normal(g);
    if (!(norm(before) > 0)) return false;
    // Each flip makes the worse of both triangles better, by more than rounding; so this ends.
    const double shape =
        least_gain * std::min(shape_of({a, b, corner}, cross(b - a, corner - a)), shape_of({a, b, across}, before)) +
        least_shape;
    for (const std::array<Vec3, 3>& made : {std::array{a, across, corner}, std::array{across, b, corner}}) {
      const Vec3 after = cross(made[1] - made[0], made[2] - made[0]);
      if (!(shape_of(made, after) > shape)) return false;
      if (dot(before, after) < least_turn_cosine * norm(before) * norm(after)) return false;
    }
    return allow_(h, height + moved_[e.idx()]);
  }

  void flip(HalfEdgeH h, double height) {
    const HalfEdgeH next = mesh_.next_halfedge_handle(h), last = mesh_.next_halfedge_handle(next);
    const FaceH f = mesh_.face_handle(h), g = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
    const EdgeH e = mesh_.edge_handle(h);
    const bool is_feature = mesh_.is_feature(e);
    const double moved = is_feature ? std::exchange(moved_[e.idx()], 0.0) + height : 0;
    flipped_.push_back(
        {mesh_.from_vertex_handle(h), mesh_.to_vertex_handle(h), mesh_.to_vertex_handle(next), is_feature, moved});
    --triangles_of_[tag_of(f)];
    ++triangles_of_[tag_of(g)];
    for (const HalfEdgeH side : {next, last}) {
      double& known = moved_[mesh_.edge_handle(side).idx()];
      known = std::max(known, moved);
    }
    mesh_.flip_behind_corner(h);
    // What could not be flipped next to the two may be able to now.
    for (const FaceH changed : {f, g}) {
      offer(changed);
      for (const FaceH beside : mesh_.ff_range(changed)) offer(beside);
    }
  }

  FeatureMesh& mesh_;
  const solid::Surface& surface_;
  const sizing::SizeField& nearest_;
  const std::function<bool(HalfEdgeH, double)>& allow_;
  std::vector<double> moved_;                         // by edge: how far it is from where its feature was at first
  std::map<std::int32_t, std::size_t> triangles_of_;  // by tag, where tags have names
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::vector<FlippedCap> flipped_;
};

}  // namespace

EdgeDiamond::EdgeDiamond(const FeatureMesh& mesh, OpenMesh::EdgeHandle e) {
  const auto h = mesh.halfedge_handle(e, 0), twin = mesh.halfedge_handle(e, 1);
  ends = {mesh.from_vertex_handle(h), mesh.to_vertex_handle(h)};
  across = {mesh.to_vertex_handle(mesh.next_halfedge_handle(h)),
            mesh.to_vertex_handle(mesh.next_halfedge_handle(twin))};
  for (std::size_t i = 0; i < 2; ++i) {
    end_points[i] = mesh.position(ends[i]);
    across_points[i] = mesh.position(across[i]);
  }
}

bool EdgeDiamond::is_beyond_delaunay() const {
  const Angle left(across_points[0], end_points[0], end_points[1]),
      right(across_points[1], end_points[0], end_points[1]);
  const double sine = -(left.sine * right.cosine + left.cosine * right.sine);
  if (!(sine > 0)) return false;  // nearly always
  const double scale = std::hypot(left.cosine, left.sine) * std::hypot(right.cosine, right.sine);
  return sine / std::max(scale, 1e-300) > least_excess;
}

double EdgeDiamond::height() const {
  const Vec3 edge = end_points[1] - end_points[0], diagonal = across_points[1] - across_points[0];
  const Vec3 normal = cross(edge, diagonal);
  const double length = norm(normal);
  // The two edges are nearly parallel only where a flip is refused anyway.
  if (length <= 1e-12 * norm(edge) * norm(diagonal)) return norm(edge);
  return std::abs(dot(across_points[0] - end_points[0], normal)) / length;
}

double EdgeDiamond::least_cosine_after_flip() const {
  const auto [a, b] = end_points;
  const auto [left, right] = across_points;
  const Vec3 before = cross(b - a, left - a) + cross(right - a, b - a);
  const Vec3 first = cross(right - a, left - a), second = cross(left - b, right - b);
  auto cosine = [&](const Vec3& n) { return dot(n, before) / std::max(norm(n) * norm(before), 1e-300); };
  return std::min(cosine(first), cosine(second));
}

std::vector<FlippedCap> flip_caps(FeatureMesh& mesh, const solid::Surface& surface, const sizing::SizeField& nearest,
                                  const std::function<bool(HalfEdgeH, double)>& allow) {
  return CapFlipper(mesh, surface, nearest, allow).run();
}

}  // namespace hexpipe::tetmesh::surface
