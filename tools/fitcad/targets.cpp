#include "tools/fitcad/targets.hpp"

#include <algorithm>
#include <utility>

#include "common/mesh/facet_key.hpp"

namespace hexpipe::fitcad {
namespace {

// Distances by the length of an edge, or by the mean length of the edges at a vertex.
//
// tetmesh and assemble do not move vertices at the ends of the CAD's curves, but for rounding.
constexpr double corner_reach = 1e-3;
// An edge of the mesh lies along a curve if its ends are this near to one, and its middle as near as the middle of a
// chord may be. All curves that are features are edges of the mesh: those between tags are edges between these tags, so
// other edges can only be along a curve with one tag around it.
constexpr double end_reach = 0.04, middle_reach = 0.2;
// A face may be the nearest one though its triangles are further away than those of another, by up to this much.
constexpr double face_reach = 0.1;

// By the diagonal: a vertex this near to its place does not move, so flat faces stay flat to the last bit.
constexpr double rounding = 1e-12;

enum class OnCurve : std::uint8_t { no, within_tag, between_tags };

// What the facets at an edge of the boundary say of it.
struct BoundaryEdge {
  std::int32_t facets = 0;
  std::int32_t tag = 0;
  bool between_tags = false;
};

// The nearest point of the curves on which a vertex with these tags may be.
std::optional<Foot> curve_foot(const CadShape& shape, const Vec3& to, double reach,
                               const std::vector<std::int32_t>& tags, bool may_leave) {
  return may_leave ? shape.on_curves_within(to, reach, tags.front()) : shape.on_curves(to, reach, tags);
}

class TargetSearch {
 public:
  TargetSearch(const MixedMesh& mesh, const CadShape& shape, double reach) : mesh_(mesh), shape_(shape), reach_(reach) {
    add_facets(mesh.triangles);
    add_facets(mesh.quads);
  }

  Targets run() && {
    for (std::size_t v = 0; v < lengths_.size(); ++v) lengths_[v] /= std::max(edge_counts_[v], 1);
    find_curve_vertices();
    Targets result;
    result.of.resize(mesh_.points.size());
    for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
      if (edge_counts_[v] == 0) continue;
      const auto vertex = static_cast<Vertex>(v);
      result.of[v] = target_of(vertex);
      const double distance = norm(result.of[v].at - mesh_.points[v]);
      if (distance > rounding * shape_.diagonal() && distance <= reach_ * lengths_[v]) continue;
      result.of[v].at = mesh_.points[v];
      if (distance > reach_ * lengths_[v]) result.strays.push_back(vertex);
    }
    result.lengths = std::move(lengths_);
    result.tags = std::move(tags_);
    return result;
  }

 private:
  template <int N>
  void add_facets(const CellBlock<N>& facets) {
    lengths_.resize(mesh_.points.size());
    edge_counts_.resize(mesh_.points.size());
    tags_.resize(mesh_.points.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
      for (int k = 0; k < N; ++k) add_edge(facets.cells[i][k], facets.cells[i][(k + 1) % N], facets.tags[i]);
  }

  void add_edge(Vertex a, Vertex b, std::int32_t tag) {
    BoundaryEdge& edge = edges_[edge_key(a, b)];
    edge.between_tags = edge.between_tags || (edge.facets > 0 && edge.tag != tag);
    edge.tag = tag;
    ++edge.facets;
    for (const Vertex v : {a, b}) {
      lengths_[v] += norm(mesh_.points[a] - mesh_.points[b]);
      ++edge_counts_[v];
      if (std::ranges::find(tags_[v], tag) == tags_[v].end()) tags_[v].push_back(tag);
    }
  }

  void find_curve_vertices() {
    on_curve_.resize(mesh_.points.size());
    for (const auto& [ends, edge] : edges_) {
      const bool between_tags = edge.between_tags || edge.facets != 2;
      if (!between_tags && !is_along_curve(ends, edge.tag)) continue;
      for (const Vertex v : ends)
        on_curve_[v] = std::max(on_curve_[v], between_tags ? OnCurve::between_tags : OnCurve::within_tag);
    }
  }

  bool is_along_curve(const VertexKey<2>& ends, std::int32_t tag) const {
    const Vec3 &a = mesh_.points[ends[0]], &b = mesh_.points[ends[1]];
    const double length = norm(b - a);
    return shape_.on_curves_within(a, end_reach * length, tag) && shape_.on_curves_within(b, end_reach * length, tag) &&
           shape_.on_curves_within(0.5 * (a + b), middle_reach * length, tag);
  }

  Target target_of(Vertex v) const {
    const Vec3& p = mesh_.points[v];
    const double length = lengths_[v];
    if (on_curve_[v] != OnCurve::no) {
      if (const auto corner = shape_.on_corners(p, corner_reach * length)) return {Place::corner, *corner};
      const bool may_leave = on_curve_[v] == OnCurve::within_tag;
      if (const auto foot = curve_foot(shape_, p, reach_ * length, tags_[v], may_leave))
        return {Place::curve, foot->at, may_leave};
    }
    return {Place::face, shape_.on_faces(p, face_reach * length, tags_[v]).at};
  }

  const MixedMesh& mesh_;
  const CadShape& shape_;
  const double reach_;
  KeyMap<2, BoundaryEdge> edges_;
  std::vector<double> lengths_;
  std::vector<std::int32_t> edge_counts_;
  std::vector<std::vector<std::int32_t>> tags_;
  std::vector<OnCurve> on_curve_;
};

}  // namespace

Vec3 Targets::on_face(const CadShape& shape, Vertex v, const Vec3& to) const {
  return shape.on_faces(to, face_reach * lengths[v], tags[v]).at;
}

Vec3 Targets::slid(const CadShape& shape, Vertex v, const Vec3& to) const {
  const Target& target = of[v];
  if (target.place == Place::face) return on_face(shape, v, to);
  if (target.place != Place::curve) return target.at;
  const auto foot = curve_foot(shape, to, lengths[v], tags[v], target.may_leave);
  return foot ? foot->at : target.at;
}

Targets find_targets(const MixedMesh& mesh, const CadShape& shape, double reach) {
  return TargetSearch(mesh, shape, reach).run();
}

}  // namespace hexpipe::fitcad
