// Half-edge collapses in rounds, each followed by Lawson's flips around it. Faces carry the removed vertices that lie
// nearest to them, and points on edges, so that the distance from the original surface is known at each step (Klein,
// Liebich, Straßer 1996). Edges where sheets meet come first, then regions, at the same time, then the places where
// regions meet. The regions do not depend on the number of threads.

#include "tools/tetmesh/surface/remesh_steps.hpp"

#include <algorithm>
#include <limits>

#include "common/mesh/box_tree.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/surface/bulges.hpp"
#include "tools/tetmesh/surface/delaunay_flips.hpp"
#include "tools/tetmesh/surface/mesh_regions.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// A collapse may turn a face's normal by an angle of this cosine, and make triangles of this shape (1 is equilateral).
constexpr double least_cosine = 0.3, least_shape = 1e-3;
// Edges that bend by less than this share of the deviation are flat.
constexpr double flat_bend = 0.05;
// On the other edges, points are watched at most this many deviations apart. To watch more takes longer than to find
// out, on the surface that was made, where some came too far.
constexpr double watch_spacing = 3;
constexpr double most_samples = 64;  // along an edge
// A flip that mends a triangle of less than this shape may leave the surface this many times as far as other changes: a
// vertex between two others on a straight row otherwise keeps the flat triangle that the three make. Times the share of
// the deviation that the caller gives (removal_share in surface_remesh.cpp) it has to stay below 1.
constexpr double thin_shape = 0.1, allowance_for_thin = 1.15;
// Removing some vertices makes others removable. More rounds found nothing.
constexpr int most_rounds = 20;
// Vertices within this share of the longest edge of an earlier fault are firm: about as far as an edge reaches.
constexpr double firm_reach = 0.4;
// Faces within this many deviations of a place where faces strayed are measured at points of a grid with this many
// parts on an edge.
constexpr double stray_reach = 4;
constexpr int close_parts = 8;

using Corners = std::array<Vec3, 3>;

Vec3 area_normal(const Corners& c) {
  return cross(c[1] - c[0], c[2] - c[0]);
}

double shape_of_triangle(const Corners& c) {
  return shape_of(c, area_normal(c));
}

Vec3 middle_of(const Corners& c) {
  return (c[0] + c[1] + c[2]) * (1.0 / 3);
}

// A change of the mesh: the faces that go or change, what they become, and where their removed vertices would go.
struct Change {
  bool flat = false;  // everything that changes lies in one plane, before and after
  bool may_bulge = false;
  std::vector<FaceH> faces;
  std::vector<Corners> corners;
  std::vector<Vec3> places;         // where to measure: on the new faces and in the middle of each new edge
  std::vector<Vec3> strays;         // removed vertices of all faces that change
  std::vector<std::size_t> target;  // by stray: the index of its new face
};

// By face: the points that must stay near it.
using Strays = std::vector<std::vector<Vec3>>;

// Points on the edges of the original surface where it bends. Across these edges, a new edge can leave the surface
// without a vertex nearby that would show it.
Strays samples_of_edges(const FeatureMesh& mesh, const sizing::SizeField& deviation) {
  Strays strays(mesh.n_faces());
  for (const EdgeH e : mesh.edges()) {
    const HalfEdgeH h = mesh.halfedge_handle(e, 0);
    const Vec3 start = mesh.position(mesh.from_vertex_handle(h));
    const Vec3 along = mesh.position(mesh.to_vertex_handle(h)) - start;
    if (!mesh.is_boundary(e) && deviation.is_at_least(EdgeDiamond(mesh, e).height() / flat_bend, start)) continue;
    const FaceH f = mesh.face_at(e);
    const double parts = std::min(most_samples, std::ceil(norm(along) / (watch_spacing * deviation.at(start))));
    // NOLINTNEXTLINE(clang-analyzer-security.FloatLoopCounter): small whole numbers
    for (double i = 1; i < parts; ++i) strays[f.idx()].push_back(start + i / parts * along);
  }
  return strays;
}

// Gives each point to the face of the mesh that is nearest to it.
void watch_points(const FeatureMesh& mesh, std::span<const Vec3> watched, Strays& strays) {
  if (watched.empty()) return;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (const VertexH v : mesh.vertices()) points.push_back(mesh.position(v));
  for (const FaceH f : mesh.faces()) {
    const auto [a, b, c] = mesh.corners(f);
    triangles.push_back({a.idx(), b.idx(), c.idx()});
  }
  const DistanceIndex faces(points, triangles);
  std::int32_t nearest = no_index;
  for (const Vec3& p : watched) {
    faces.distance(p, nearest);
    strays[nearest].push_back(p);
  }
}

// Places where faces strayed from the original surface.
class StrayedPlaces {
 public:
  StrayedPlaces(std::span<const Vec3> places, const sizing::SizeField& deviation)
      : boxes_(boxes_around(places, deviation)), tree_(boxes_, std::vector<double>(boxes_.size())) {}

  // Whether a place is within `stray_reach` deviations of the face's bounding box, along each axis.
  bool are_near(const Corners& face) const {
    const Box around = Box::around(face);
    bool found = false;
    tree_.for_each_near(around, [&](std::int32_t i) { found = found || boxes_[i].meets(around); });
    return found;
  }

 private:
  static std::vector<Box> boxes_around(std::span<const Vec3> places, const sizing::SizeField& deviation) {
    std::vector<Box> boxes;
    for (const Vec3& p : places) {
      const double reach = stray_reach * deviation.at(p);
      boxes.push_back({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}});
    }
    return boxes;
  }

  std::vector<Box> boxes_;
  BoxTree tree_;
};

class VertexRemover {
 public:
  VertexRemover(FeatureMesh& mesh, const DistanceIndex& original, const RemovalLimits& limits, Strays& strays,
                const StrayedPlaces& strayed, const FirmVertices& firm)
      : mesh_(mesh),
        original_(original),
        deviation_(&limits.deviation),
        longest_edge_(limits.longest_edge),
        bulge_(limits.bulge),
        strays_(strays),
        strayed_(strayed),
        firm_(firm) {}
  // A remover that changes nothing outside a region.
  VertexRemover(const VertexRemover& whole, const MeshRegions& regions, std::size_t region) : VertexRemover(whole) {
    regions_ = &regions;
    region_ = region;
  }

  // Returns the vertices that could not be removed.
  std::vector<VertexH> remove(std::vector<VertexH> waiting) {
    std::vector<VertexH> left;
    for (int round = 0; round < most_rounds && !waiting.empty(); ++round) {
      left.clear();
      for (const VertexH v : waiting)
        if (!remove(v)) left.push_back(v);
      const bool stuck = left.size() == waiting.size();
      std::swap(waiting, left);
      if (stuck) break;
    }
    return waiting;
  }

  void flip(std::span<const EdgeH> edges) {
    for (const EdgeH e : edges) queue_.push(e);
    flip_queued();
  }
  // Flips only edges of thin triangles, within `deviation`.
  void flip_thin(std::span<const EdgeH> edges, const sizing::SizeField& deviation) {
    deviation_ = &deviation;
    bulge_ = std::max(1.0, bulge_ / allowance_for_thin);
    only_thin_ = true;
    flip(edges);
  }
  // Flips that were wanted, but not all inside the region.
  std::span<const EdgeH> wanted() const { return wanted_; }

 private:
  struct Choice {
    double shape;
    HalfEdgeH collapse;
  };

  bool remove(VertexH v);
  bool remove_with_copies(VertexH v);
  bool fit_all(std::span<const HalfEdgeH> collapses);
  void collapse(HalfEdgeH h);
  void gather_faces(VertexH v);
  double shape_after(HalfEdgeH collapse);
  void describe_collapse(HalfEdgeH collapse);
  bool fits() { return strays_fit() && (change_.flat || faces_fit()); }
  bool strays_fit();
  bool may_bulge(VertexH corner) const { return bulge_ > 1 && !firm_.has(corner); }
  bool is_within(double distance, const Vec3& p) const;
  bool is_near(const Vec3& p);
  bool faces_fit();
  bool fits_closely(const Corners& face);
  void settle_strays();
  void flip_queued();
  bool allow_flip(EdgeH e, const EdgeDiamond& diamond);

  FeatureMesh& mesh_;
  const DistanceIndex& original_;
  std::int32_t nearest_ = no_index;  // the triangle of the original that was measured last
  const sizing::SizeField* deviation_;
  const sizing::SizeField& longest_edge_;
  double bulge_;
  bool only_thin_ = false;
  Strays& strays_;
  const StrayedPlaces& strayed_;
  const FirmVertices& firm_;
  const MeshRegions* regions_ = nullptr;  // null: everywhere
  std::size_t region_ = 0;
  // A face at the vertex that may go.
  struct FaceAround {
    std::array<VertexH, 3> handles;
    Corners corners;
    std::size_t moved;  // the corner at the vertex
    Vec3 normal;        // of twice the area
    double twice_area;
  };
  bool grows_too_long(const FaceAround& face, HalfEdgeH collapse) const;
  std::vector<FaceAround> faces_;
  std::vector<Choice> choices_;
  Change change_;
  std::vector<geometry::TriangleDistance> distances_;  // to the change's faces
  EdgeQueue queue_;
  std::vector<EdgeH> wanted_;
};

bool VertexRemover::remove(VertexH v) {
  if (regions_ && !regions_->has_around(region_, mesh_, v)) return false;
  if (mesh_.has_copies(v)) return !regions_ && remove_with_copies(v);
  choices_.clear();
  gather_faces(v);
  const bool on_feature = mesh_.is_on_feature(v);
  for (const HalfEdgeH h : mesh_.voh_range(v)) {
    if (on_feature && !mesh_.is_feature(mesh_.edge_handle(h))) continue;
    if (const double shape = shape_after(h); shape > least_shape) choices_.push_back({shape, h});
  }
  std::ranges::stable_sort(choices_, std::ranges::greater(), &Choice::shape);
  for (const Choice& choice : choices_) {
    if (!mesh_.is_collapse_ok(choice.collapse)) continue;
    describe_collapse(choice.collapse);
    if (!fits()) continue;
    collapse(choice.collapse);
    flip_queued();
    return true;
  }
  return false;
}

// Does the collapse that was described last.
void VertexRemover::collapse(HalfEdgeH h) {
  const VertexH target = mesh_.to_vertex_handle(h);
  mesh_.collapse_edge(h);
  settle_strays();
  for (const EdgeH e : mesh_.ve_range(target)) queue_.push(e);
  for (const FaceH f : mesh_.vf_range(target))
    for (const EdgeH e : mesh_.fe_range(f)) queue_.push(e);
}

// Removes all copies in the same way along the joint, or none.
bool VertexRemover::remove_with_copies(VertexH v) {
  choices_.clear();
  for (const HalfEdgeH h : mesh_.voh_range(v)) {
    if (!mesh_.is_joint(mesh_.edge_handle(h))) continue;
    double shape = std::numeric_limits<double>::max();
    for (const HalfEdgeH copy : mesh_.copies(h)) {
      gather_faces(mesh_.from_vertex_handle(copy));
      shape = std::min(shape, shape_after(copy));
    }
    if (shape > least_shape) choices_.push_back({shape, h});
  }
  std::ranges::stable_sort(choices_, std::ranges::greater(), &Choice::shape);
  for (const Choice& choice : choices_) {
    const std::vector<HalfEdgeH> collapses = mesh_.copies(choice.collapse);
    if (!fit_all(collapses)) continue;
    for (const HalfEdgeH h : collapses) {
      describe_collapse(h);
      fits();
      collapse(h);
    }
    flip_queued();
    return true;
  }
  return false;
}

bool VertexRemover::fit_all(std::span<const HalfEdgeH> collapses) {
  return std::ranges::all_of(collapses, [&](HalfEdgeH h) {
    if (!mesh_.is_collapse_ok(h)) return false;
    describe_collapse(h);
    return fits();
  });
}

void VertexRemover::gather_faces(VertexH v) {
  faces_.clear();
  for (const FaceH f : mesh_.vf_range(v)) {
    FaceAround& face = faces_.emplace_back();
    face.handles = mesh_.corners(f);
    for (std::size_t i = 0; i < 3; ++i) {
      face.corners[i] = mesh_.position(face.handles[i]);
      if (face.handles[i] == v) face.moved = i;
    }
    face.normal = area_normal(face.corners);
    face.twice_area = norm(face.normal);
  }
}

// Whether an edge of the face gets too long, and longer than it was, when its corner moves. Where the surface bends so
// much that few edges stay near it, long ones along it would be all that fits.
bool VertexRemover::grows_too_long(const FaceAround& face, HalfEdgeH collapse) const {
  const Vec3 target = mesh_.position(mesh_.to_vertex_handle(collapse));
  const HalfEdgeH twin = mesh_.opposite_halfedge_handle(collapse);
  return std::ranges::any_of(std::array<std::size_t, 2>{1, 2}, [&](std::size_t step) {
    const std::size_t end = (face.moved + step) % 3;
    const double length = norm(face.corners[end] - target);
    if (length <= norm(face.corners[end] - face.corners[face.moved]) || longest_edge_.is_at_least(length, target))
      return false;
    // From these, an edge leads to the target already.
    return face.handles[end] != mesh_.to_vertex_handle(mesh_.next_halfedge_handle(collapse)) &&
           face.handles[end] != mesh_.to_vertex_handle(mesh_.next_halfedge_handle(twin));
  });
}

// The least shape of the faces that move, which were gathered before; negative if one of them turns or grows too far.
double VertexRemover::shape_after(HalfEdgeH collapse) {
  const VertexH to = mesh_.to_vertex_handle(collapse);
  const Vec3 target = mesh_.position(to);
  double least = std::numeric_limits<double>::max();
  for (const FaceAround& face : faces_) {
    if (std::ranges::find(face.handles, to) != face.handles.end()) continue;
    Corners after = face.corners;
    after[face.moved] = target;
    const Vec3 m = area_normal(after);
    if (dot(face.normal, m) < least_cosine * face.twice_area * norm(m)) return -1;
    if (grows_too_long(face, collapse)) return -1;
    least = std::min(least, shape_of(after, m));
  }
  return least;
}

void VertexRemover::describe_collapse(HalfEdgeH collapse) {
  const VertexH v = mesh_.from_vertex_handle(collapse), to = mesh_.to_vertex_handle(collapse);
  change_.flat = mesh_.is_flat_around(v);
  change_.may_bulge = true;
  change_.faces.clear();
  change_.corners.clear();
  change_.places.clear();
  change_.strays.assign(1, mesh_.position(v));
  for (const FaceH f : mesh_.vf_range(v)) {
    const auto& of_face = strays_[f.idx()];
    change_.strays.insert(change_.strays.end(), of_face.begin(), of_face.end());
    const auto handles = mesh_.corners(f);
    if (std::ranges::find(handles, to) != handles.end()) continue;
    Corners after;
    std::size_t moved = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (handles[i] == v) moved = i;
      const VertexH corner = handles[i] == v ? to : handles[i];
      after[i] = mesh_.position(corner);
      change_.may_bulge = change_.may_bulge && may_bulge(corner);
    }
    change_.faces.push_back(f);
    change_.corners.push_back(after);
    // One of the two edges at the corner that moved belongs to the next face, too, or was there before.
    change_.places.push_back(middle_of(after));
    change_.places.push_back(0.5 * (after[moved] + after[(moved + 1) % 3]));
  }
}

// Finds the nearest of the new faces for each stray.
bool VertexRemover::strays_fit() {
  change_.target.clear();
  distances_.clear();
  for (const Corners& c : change_.corners) distances_.emplace_back(c[0], c[1], c[2]);
  for (const Vec3& p : change_.strays) {
    double least = std::numeric_limits<double>::max();
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < distances_.size(); ++i)
      if (const double d = distances_[i].squared(p); d < least) {
        least = d;
        nearest = i;
      }
    if (!is_within(std::sqrt(least), p)) return false;
    change_.target.push_back(nearest);
  }
  return true;
}

// Whether the change may have this distance from the original surface.
bool VertexRemover::is_within(double distance, const Vec3& p) const {
  return deviation_->is_at_least(change_.may_bulge ? distance / bulge_ : distance, p);
}

bool VertexRemover::is_near(const Vec3& p) {
  return is_within(original_.distance(p, nearest_, deviation_->least()), p);
}

// Measures from the original surface.
bool VertexRemover::faces_fit() {
  return std::ranges::all_of(change_.places, [&](const Vec3& p) { return is_near(p); }) &&
         std::ranges::all_of(change_.corners, [&](const Corners& face) { return fits_closely(face); });
}

bool VertexRemover::fits_closely(const Corners& face) {
  if (!strayed_.are_near(face)) return true;
  for (int i = 0; i <= close_parts; ++i)
    for (int j = 0; i + j <= close_parts; ++j)
      if (!is_near((1.0 / close_parts) * (i * face[0] + j * face[1] + (close_parts - i - j) * face[2]))) return false;
  return true;
}

void VertexRemover::settle_strays() {
  for (const FaceH f : change_.faces) strays_[f.idx()].clear();
  for (std::size_t i = 0; i < change_.strays.size(); ++i)
    strays_[change_.faces[change_.target[i]].idx()].push_back(change_.strays[i]);
}

void VertexRemover::flip_queued() {
  flip_towards_delaunay(
      mesh_, queue_, [&](EdgeH e, const EdgeDiamond& diamond) { return allow_flip(e, diamond); },
      [&](EdgeH) { settle_strays(); });
}

bool VertexRemover::allow_flip(EdgeH e, const EdgeDiamond& diamond) {
  if (regions_ && !regions_->has(region_, diamond)) {
    wanted_.push_back(e);
    return false;
  }
  const FaceH left = mesh_.face_handle(mesh_.halfedge_handle(e, 0)),
              right = mesh_.face_handle(mesh_.halfedge_handle(e, 1));
  if (mesh_.is_held(left) || mesh_.is_held(right)) return false;
  const auto bulges = [&](VertexH corner) { return may_bulge(corner); };
  change_.may_bulge = std::ranges::all_of(diamond.ends, bulges) && std::ranges::all_of(diamond.across, bulges);
  if (!is_within(diamond.height(), diamond.end_points[0])) return false;
  const auto [a, b] = diamond.end_points;
  const auto [l, r] = diamond.across_points;
  if (only_thin_ && std::min(shape_of_triangle({a, b, l}), shape_of_triangle({a, b, r})) >= thin_shape) return false;
  change_.strays = strays_[left.idx()];
  change_.strays.insert(change_.strays.end(), strays_[right.idx()].begin(), strays_[right.idx()].end());
  change_.faces.assign({left, right});
  change_.corners.assign({Corners{a, r, l}, Corners{b, l, r}});
  change_.places.assign({middle_of(change_.corners[0]), middle_of(change_.corners[1]), 0.5 * (l + r)});
  change_.flat = diamond.height() < plane_tolerance * norm(diamond.end_points[1] - diamond.end_points[0]);
  return fits();
}

}  // namespace

std::size_t remove_vertices(FeatureMesh& mesh, const DistanceIndex& original, const RemovalLimits& limits,
                            const CloseWatch& watch) {
  const sizing::SizeField& deviation = limits.deviation;
  const auto on_features_first = [&](std::vector<VertexH>& vertices) {
    std::ranges::stable_partition(vertices, [&](VertexH v) { return mesh.is_on_feature(v); });
  };
  Strays strays = samples_of_edges(mesh, deviation);
  watch_points(mesh, watch.left_behind, strays);
  const StrayedPlaces strayed(watch.strayed, deviation);
  FirmVertices firm;
  if (limits.bulge > 1) firm = FirmVertices(mesh, watch.faults(), firm_reach * limits.longest_edge);
  VertexRemover everywhere(mesh, original, limits, strays, strayed, firm);
  std::vector<VertexH> at_joints;
  for (const VertexH v : mesh.vertices())
    if (!mesh.is_kept(v) && mesh.has_copies(v) && mesh.place(v) == v.idx()) at_joints.push_back(v);
  const std::size_t left_at_joints = everywhere.remove(std::move(at_joints)).size();

  const MeshRegions regions(mesh, region_vertices);
  std::vector<std::vector<VertexH>> waiting(regions.size());
  for (const VertexH v : mesh.vertices())
    if (!mesh.is_kept(v) && !mesh.has_copies(v)) waiting[regions.of(v)].push_back(v);

  std::vector<VertexRemover> removers;
  for (std::size_t region = 0; region < regions.size(); ++region) removers.emplace_back(everywhere, regions, region);
  parallel_for(static_cast<std::int64_t>(regions.size()), 1, [&](std::int64_t i) {
    on_features_first(waiting[i]);
    waiting[i] = removers[i].remove(std::move(waiting[i]));
  });

  for (const VertexRemover& remover : removers) everywhere.flip(remover.wanted());
  std::vector<VertexH> left;
  for (const std::vector<VertexH>& some : waiting) left.insert(left.end(), some.begin(), some.end());
  on_features_first(left);
  left = everywhere.remove(std::move(left));
  const std::vector<EdgeH> edges(mesh.edges().begin(), mesh.edges().end());
  everywhere.flip(edges);
  everywhere.flip_thin(edges, allowance_for_thin * deviation);
  if (limits.bulge > 1) step_out(mesh, strays, firm, deviation);
  return left.size() + left_at_joints;
}

}  // namespace hexpipe::tetmesh::surface
