#include "tools/tetmesh/volume/field_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/mesh/defaults.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

constexpr double aligned_cosine = 0.9396926207859084;  // of 20 degrees between a normal and the nearest axis
// If the squared ratio is at least this, the longest side of a triangle counts as the diagonal of a square, not as a
// side.
constexpr double diagonal_ratio = 1.21;

Vec3 normalized(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? v * (1 / length) : Vec3{0, 0, 1};
}

class SurfaceReader {
 public:
  SurfaceReader(const solid::Surface& surface, double feature_angle)
      : surface_(surface),
        feature_cosine_(cosine_of_degrees(feature_angle)),
        nodes_(surface.points.size()),
        legs_(nodes_.size()),
        creased_(nodes_.size()) {}

  std::vector<SurfaceNode> read() {
    add_normals();
    for (SurfaceNode& node : nodes_) node.normal = normalized(node.normal);
    find_interfaces();
    geometry::for_each_edge(surface_.points.size(), surface_.triangles,
                            [&](std::span<const geometry::HalfEdge> edge) { add_edge(edge); });
    parallel_for(static_cast<std::int64_t>(nodes_.size()), 64,
                 [&](std::int64_t v) { creased_[v] ? finish_creased(nodes_[v]) : finish_smooth(v); });
    find_vague();
    return std::move(nodes_);
  }

 private:
  // The crosses of a vertex's edges, without diagonals.
  struct Legs {
    fields::Harmonics sum = fields::Harmonics::Zero();
    double weight = 0;
  };

  const Vec3& start(geometry::HalfEdge h) const { return surface_.points[geometry::start_of(surface_.triangles, h)]; }
  const Vec3& end(geometry::HalfEdge h) const { return surface_.points[geometry::end_of(surface_.triangles, h)]; }
  void add_normals();
  void find_interfaces();
  void add_edge(std::span<const geometry::HalfEdge> edge);
  bool is_diagonal(geometry::HalfEdge h) const;
  void add_leg(Vertex v, const Vec3& along, double weight);
  void finish_smooth(std::int64_t v);
  void finish_creased(SurfaceNode& node) const;
  void find_vague();

  const solid::Surface& surface_;
  double feature_cosine_;
  std::vector<SurfaceNode> nodes_;
  std::vector<Vec3> normals_;  // of triangles
  std::vector<Legs> legs_;
  std::vector<bool> creased_;
};

// The weights are the triangles' angles at the vertex.
void SurfaceReader::add_normals() {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(surface_.triangles.size()); ++t) {
    const Vec3 normal = normalized(cross(end(3 * t) - start(3 * t), end(3 * t + 1) - start(3 * t)));
    const fields::Harmonics harmonics = fields::harmonics_of_axis(normal);
    normals_.push_back(normal);
    for (geometry::HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      const Vec3 to_next = end(h) - start(h), to_previous = start(geometry::previous_in_triangle(h)) - start(h);
      const double angle = angle_between(to_next, to_previous);
      SurfaceNode& node = nodes_[geometry::start_of(surface_.triangles, h)];
      node.normal += angle * normal;
      node.suggested += angle * harmonics;
    }
  }
}

void SurfaceReader::find_interfaces() {
  for (SurfaceNode& node : nodes_) node.is_on_interface = true;
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
    if (surface_.shells[surface_.shell_of[t]].in_front == solid::outside_region)
      for (const Vertex v : surface_.triangles[t]) nodes_[v].is_on_interface = false;
}

bool SurfaceReader::is_diagonal(geometry::HalfEdge h) const {
  const auto squared = [&](geometry::HalfEdge e) { return norm_squared(end(e) - start(e)); };
  return squared(h) >
         diagonal_ratio * std::max(squared(geometry::next_in_triangle(h)), squared(geometry::previous_in_triangle(h)));
}

void SurfaceReader::add_edge(std::span<const geometry::HalfEdge> edge) {
  const geometry::HalfEdge h = edge[0], twin = edge.back();
  const Vec3 along = normalized(end(h) - start(h));
  // Where sheets meet, there are more triangles, and at the free border of a baffle there is one.
  const bool is_crease = edge.size() != 2 || dot(normals_[geometry::triangle_of(h)],
                                                 normals_[geometry::triangle_of(twin)]) < feature_cosine_;
  const double weight = 1 - 0.5 * is_diagonal(h) - 0.5 * is_diagonal(twin);
  for (const Vertex v : {geometry::start_of(surface_.triangles, h), geometry::end_of(surface_.triangles, h)}) {
    if (is_crease) {
      creased_[v] = true;
      nodes_[v].suggested += std::numbers::pi * fields::harmonics_of_axis(along);
    } else if (weight > 0) {
      add_leg(v, along, weight);
    }
  }
}

void SurfaceReader::add_leg(Vertex v, const Vec3& along, double weight) {
  constexpr double steepest = 0.5;  // an edge that points further out of the tangent plane says little about it
  const Vec3& normal = nodes_[v].normal;
  const Vec3 in_plane = along - dot(along, normal) * normal;
  if (norm(in_plane) < steepest) return;
  legs_[v].sum += weight * fields::harmonics_of_cross(normal, normalized(in_plane));
  legs_[v].weight += weight;
}

void SurfaceReader::finish_smooth(std::int64_t v) {
  const Legs& legs = legs_[v];
  nodes_[v].suggested =
      legs.weight > 0 ? fields::Harmonics(legs.sum / legs.weight) : fields::Harmonics(fields::Harmonics::Zero());
}

void SurfaceReader::finish_creased(SurfaceNode& node) const {
  node.kind = SurfaceNode::Kind::fixed;
  node.frame = fields::nearest_frame(node.suggested);
  node.suggested *= std::sqrt(fields::frame_norm_squared / node.suggested.squaredNorm());
}

void SurfaceReader::find_vague() {
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
    for (const Vertex v : surface_.triangles[t]) {
      SurfaceNode& node = nodes_[v];
      const auto is_along = [&](const Vec3& axis) { return std::abs(dot(axis, normals_[t])) > aligned_cosine; };
      if (node.kind == SurfaceNode::Kind::fixed && std::ranges::none_of(node.frame, is_along))
        node.kind = SurfaceNode::Kind::vague;
    }
}

}  // namespace

FieldNodes make_field_nodes(const solid::Surface& surface, const TetMesh& mesh, const TetAdjacency& adjacency,
                            const sizing::SizeField& size, double feature_angle) {
  constexpr double nearest = 0.25;  // squared; keeps a single link from dominating
  FieldNodes nodes;
  nodes.points = mesh.points;
  nodes.sizes.resize(nodes.points.size());
  parallel_for(static_cast<std::int64_t>(nodes.size()), 256,
               [&](std::int64_t v) { nodes.sizes[v] = size.at(nodes.points[v]); });
  nodes.surface = SurfaceReader(surface, feature_angle).read();
  nodes.triangles = surface.triangles;
  nodes.offsets.assign(1, 0);
  for (std::size_t v = 0; v < nodes.points.size(); ++v) {
    for (const Vertex u : adjacency.neighbours_of(static_cast<Vertex>(v))) {
      const double squared = norm_squared(nodes.points[u] - nodes.points[v]) / (nodes.sizes[u] * nodes.sizes[v]);
      nodes.links.push_back({u, static_cast<float>(1 / std::max(squared, nearest))});
    }
    nodes.offsets.push_back(static_cast<std::int64_t>(nodes.links.size()));
  }
  return nodes;
}

}  // namespace hexpipe::tetmesh::volume
