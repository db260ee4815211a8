#include "tools/tetmesh/surface/crest_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

constexpr double one_degree = std::numbers::pi / 180;
// A fillet turns by this much; beyond its reach on either side, in sizes, the surface turns by no more than flat_turn.
constexpr double least_turn = 60 * one_degree, most_turn = 125 * one_degree, flat_turn = 8 * one_degree;
constexpr double fillet_reach = 0.85, flat_reach = 1.25;
// Edges that bend by less than the first angle lie in one plane. A strip of a fillet is plane up to a fraction of that.
constexpr double least_bend = 1 * one_degree, strip_bend = 0.1 * one_degree;
// In the middle of a fillet, the turns on both sides of an edge differ by less than the first share of the edge's own
// bend. At a side of the middle strip they differ by up to the second share.
constexpr double in_the_middle = 0.9, beside_the_middle = 1.1;
// On both sides, the share of all turns that go one way.
constexpr double least_one_way = 0.9;
// A line continues from one edge to the next if it turns by less than the angle, and counts if it has the least length
// in sizes. Other lines nearer to it than the last number belong to the same fillet.
constexpr double most_line_turn = 40 * one_degree, least_length = 4, same_fillet = 0.5;

struct Across {
  double turn_near = 0, turn = 0;  // of the normal, within `near` and over all of the way
  Vec3 normal_near;
  std::vector<std::int32_t> triangles;
};

// Walks straight from the middle of a half-edge into its triangle and over the next ones, up to a feature.
Across walk_across(const FieldSurface& surface, geometry::HalfEdge start, double near, double reach) {
  Across result;
  const Vec3& normal = surface.normals[geometry::triangle_of(start)];
  const Vec3 middle = surface.points[geometry::start_of(surface.triangles, start)] + 0.5 * surface.edge_vector(start);
  double gone = 0;
  const auto add = [&](const SurfacePoint& at, const Vec3&, const TriangleExit& exit) {
    result.triangles.push_back(at.triangle);
    const Vec3& here = surface.normals[at.triangle];
    result.turn = angle_between(normal, here);
    if (gone < near) {
      result.turn_near = result.turn;
      result.normal_near = here;
    }
    gone += exit.length;
    return gone < reach;
  };
  walk_straight_over(surface, {middle, geometry::triangle_of(start)}, surface.inward(start), add);
  return result;
}

class CrestFinder {
 public:
  CrestFinder(const FeatureMesh& mesh, const sizing::SizeField& size) : mesh_(mesh), size_(size), surface_(mesh, size) {
    rank_.resize(mesh.n_edges());
    parallel_for(static_cast<std::int64_t>(rank_.size()), 512,
                 [&](std::int64_t e) { rank_[e] = rank_of(mesh.edge_handle(static_cast<unsigned>(e))); });
  }

  std::vector<OpenMesh::EdgeHandle> find() {
    std::vector<OpenMesh::EdgeHandle> result;
    for (const int rank : {2, 1})
      for (const auto e : mesh_.edges()) {
        if (rank_[e.idx()] != rank) continue;
        const std::vector<OpenMesh::EdgeHandle> line = take_line(e);
        double length = 0;
        for (const auto part : line) length += mesh_.calc_edge_length(part);
        if (length < least_length * size_.at(middle(e))) continue;
        result.insert(result.end(), line.begin(), line.end());
        forget_beside(line);
      }
    return result;
  }

 private:
  Vec3 middle(OpenMesh::EdgeHandle e) const {
    const auto h = mesh_.halfedge_handle(e, 0);
    return 0.5 * (mesh_.position(mesh_.from_vertex_handle(h)) + mesh_.position(mesh_.to_vertex_handle(h)));
  }

  // 2 in the middle of a fillet, 1 at a side of the strip in the middle, 0 elsewhere.
  int rank_of(OpenMesh::EdgeHandle e) const {
    if (mesh_.is_feature(e)) return 0;
    const geometry::HalfEdge h = half_edge_of(mesh_, mesh_.halfedge_handle(e, 0)), twin = surface_.twins[h];
    const double bend =
        angle_between(surface_.normals[geometry::triangle_of(h)], surface_.normals[geometry::triangle_of(twin)]);
    if (bend < least_bend) return 0;
    const double size = size_.at(middle(e));
    const Across here = walk_across(surface_, h, fillet_reach * size, flat_reach * size);
    const Across there = walk_across(surface_, twin, fillet_reach * size, flat_reach * size);
    const double turn = here.turn_near + bend + there.turn_near;
    if (turn < least_turn || turn > most_turn || here.turn + bend + there.turn > turn + flat_turn) return 0;
    if (angle_between(here.normal_near, there.normal_near) < least_one_way * turn) return 0;
    const double off = std::abs(here.turn_near - there.turn_near);
    return off < in_the_middle * bend ? 2 : off < beside_the_middle * bend ? 1 : 0;
  }

  OpenMesh::HalfedgeHandle onward(OpenMesh::HalfedgeHandle h) const {
    const auto v = mesh_.to_vertex_handle(h);
    OpenMesh::HalfedgeHandle best;
    if (mesh_.is_on_feature(v)) return best;
    double least = most_line_turn;
    const Vec3 way = mesh_.position(v) - mesh_.position(mesh_.from_vertex_handle(h));
    for (const auto next : mesh_.voh_range(v)) {
      if (next == mesh_.opposite_halfedge_handle(h) || rank_[mesh_.edge_handle(next).idx()] == 0) continue;
      const double turn = angle_between(way, mesh_.position(mesh_.to_vertex_handle(next)) - mesh_.position(v));
      if (turn < least) {
        least = turn;
        best = next;
      }
    }
    return best;
  }

  // Follows the line both ways from an edge. No other line can have its edges afterwards.
  std::vector<OpenMesh::EdgeHandle> take_line(OpenMesh::EdgeHandle e) {
    std::vector<OpenMesh::EdgeHandle> line{e};
    rank_[e.idx()] = 0;
    for (const unsigned side : {0u, 1u})
      for (auto h = onward(mesh_.halfedge_handle(e, side)); h.is_valid(); h = onward(h)) {
        line.push_back(mesh_.edge_handle(h));
        rank_[line.back().idx()] = 0;
      }
    return line;
  }

  // Edges beside the line on its fillet are no crests.
  void forget_beside(const std::vector<OpenMesh::EdgeHandle>& line) {
    for (const auto e : line)
      for (const unsigned side : {0u, 1u}) {
        const geometry::HalfEdge h = half_edge_of(mesh_, mesh_.halfedge_handle(e, side));
        const double reach = same_fillet * size_.at(middle(e));
        for (const std::int32_t f : walk_across(surface_, h, reach, reach).triangles)
          for (const auto part : mesh_.fe_range(mesh_.face_handle(static_cast<unsigned>(f)))) rank_[part.idx()] = 0;
      }
  }

  const FeatureMesh& mesh_;
  const sizing::SizeField& size_;
  FieldSurface surface_;
  std::vector<int> rank_;  // by edge
};

}  // namespace

std::vector<OpenMesh::EdgeHandle> crest_lines(const FeatureMesh& mesh, const sizing::SizeField& size) {
  return CrestFinder(mesh, size).find();
}

void add_small_fillets(const FieldSurface& surface, BendStretch& stretch) {
  std::vector<std::int32_t> queue;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(surface.twins.size()); ++h) {
    if (!surface.crest[h]) continue;
    const double reach = flat_reach * surface.sizes[geometry::triangle_of(h)];
    const Across across = walk_across(surface, h, reach, reach);
    const Vec3& end = surface.normals[across.triangles.back()];
    const Vec3 crest =
        unit(surface.normals[geometry::triangle_of(h)] + surface.normals[geometry::triangle_of(surface.twins[h])]);
    const double turn = std::clamp(angle_between(crest, end), least_bend, 0.5 * most_turn);
    for (const std::int32_t f : across.triangles) {
      if (stretch.factor[f] > 1 || angle_between(surface.normals[f], end) < least_bend) continue;
      stretch.factor[f] = std::tan(turn) / turn;
      stretch.along[f] = unit(surface.edge_vector(h));
      queue.push_back(f);
    }
  }
  // Visits the rest of their planes.
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const std::int32_t f = queue[next];
    for (geometry::HalfEdge h = 3 * f; h < 3 * f + 3; ++h) {
      const std::int32_t g = geometry::triangle_of(surface.twins[h]);
      if (surface.feature[h] || stretch.factor[g] > 1) continue;
      if (angle_between(surface.normals[f], surface.normals[g]) > strip_bend) continue;
      stretch.factor[g] = stretch.factor[f];
      stretch.along[g] = stretch.along[f];
      queue.push_back(g);
    }
  }
}

}  // namespace hexpipe::tetmesh::surface
