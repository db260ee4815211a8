#include "tools/assemble/order/boundary_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "common/mesh/defaults.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/joined_sets.hpp"
#include "tools/assemble/shape/smooth_edges.hpp"

namespace hexpipe::assemble::order {
namespace {

constexpr double most_turn_of_arcs = 20;  // degrees, from the normal at an edge to those of facets at its ends

// Triangles repeat their last corner.
struct Facet {
  Quad corners;
  int corner_count;
};

// An edge with the facets at it.
struct EdgeFacets {
  Vertex a = -1, b = -1;
  std::vector<std::int32_t> facets{};
  bool is_sharp = true;
};

// The middle of the arc over a chord that begins and ends at this angle to it.
double height_over_middle(double length, double sine) {
  return 0.5 * length * std::tan(0.5 * std::asin(std::clamp(sine, -0.7, 0.7)));
}

class EdgeFinder {
 public:
  explicit EdgeFinder(const MixedMesh& mesh) : mesh_(mesh), patch_(mesh.triangles.size() + mesh.quads.size()) {
    collect_facets();
    find_sharp_edges();
    find_normals();
  }

  std::vector<BoundaryEdge> run() const {
    std::vector<BoundaryEdge> result;
    for (const auto& [key, edge] : edges_) {
      const Vec3 middle = 0.5 * (at(edge.a) + at(edge.b));
      const Vec3 bend = edge.is_sharp ? bend_of_curve(edge) : bend_of_face(edge);
      result.push_back({edge.a, edge.b, edge.is_sharp, normal_at(edge), middle + bend});
    }
    return result;
  }

 private:
  const Vec3& at(Vertex v) const { return mesh_.points[v]; }

  void collect_facets() {
    const auto collect = [&](const auto& block) {
      for (std::size_t i = 0; i < block.size(); ++i) {
        const auto& corners = block.cells[i];
        const auto f = static_cast<std::int32_t>(facets_.size());
        facets_.push_back({{corners[0], corners[1], corners[2], corners.back()}, static_cast<int>(corners.size())});
        tags_.push_back(block.tags[i]);
        for (std::size_t k = 0; k < corners.size(); ++k) {
          const auto key = edge_key(corners[k], corners[(k + 1) % corners.size()]);
          EdgeFacets& edge = edges_[key];
          edge.a = key[0], edge.b = key[1];
          edge.facets.push_back(f);
        }
      }
    };
    collect(mesh_.triangles);
    collect(mesh_.quads);
  }

  // An edge as a facet has it, and the way from it into the facet.
  struct Side {
    Vec3 along, inwards;
  };
  Side side_of(std::int32_t f, Vertex a, Vertex b) const {
    const Facet& facet = facets_[f];
    for (int i = 0; i < facet.corner_count; ++i) {
      const Vertex from = facet.corners[i], to = facet.corners[(i + 1) % facet.corner_count];
      if (!((from == a && to == b) || (from == b && to == a))) continue;
      // To the corners of a warped quad beside the edge, in the mean.
      const Vertex next = facet.corners[(i + 2) % facet.corner_count];
      const Vertex last = facet.corners[(i + facet.corner_count - 1) % facet.corner_count];
      return {at(to) - at(from), (at(next) - at(from)) + (at(last) - at(from))};
    }
    return {};
  }

  // The unit normal of a facet at the edge.
  Vec3 normal_of(std::int32_t f, Vertex a, Vertex b) const {
    const Side side = side_of(f, a, b);
    return unit(cross(side.along, side.inwards));
  }

  void find_sharp_edges() {
    JoinedSets patches(facets_.size());
    for (auto& [key, edge] : edges_) {
      edge.is_sharp = !shape::is_smooth_edge(edge.facets, tags_, [&](std::int32_t f) {
        const Side side = side_of(f, edge.a, edge.b);
        return shape::away_from_edge({}, side.along, side.inwards);
      });
      if (!edge.is_sharp)
        patches.join(edge.facets[0], edge.facets[1]);
      else
        sharp_ends_[edge.a].push_back(edge.b), sharp_ends_[edge.b].push_back(edge.a);
    }
    for (std::size_t f = 0; f < patch_.size(); ++f) patch_[f] = patches.of(static_cast<std::int32_t>(f));
  }

  // Each facet adds to the normals of its corners, with the weights of
  // N. Max: Weights for computing vertex normals from facet normals (J. Graphics Tools, 1999): exact on spheres.
  void find_normals() {
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      const Facet& facet = facets_[f];
      for (int i = 0; i < facet.corner_count; ++i) {
        const Vec3 o = at(facet.corners[i]);
        const Vec3 next = at(facet.corners[(i + 1) % facet.corner_count]) - o;
        const Vec3 last = at(facet.corners[(i + facet.corner_count - 1) % facet.corner_count]) - o;
        const double weight = norm_squared(next) * norm_squared(last);
        if (weight > 0) normals_[{facet.corners[i], patch_[f]}].push_back((1 / weight) * cross(next, last));
      }
    }
  }

  Vec3 normal_at(const EdgeFacets& edge) const {
    Vec3 sum;
    for (const std::int32_t f : edge.facets) sum += normal_of(f, edge.a, edge.b);
    const Vec3 first = normal_of(edge.facets[0], edge.a, edge.b);
    return norm(sum) > 0.5 ? unit(sum) : first;
  }

  // The surface's normal at an end of the edge, by the facets there that turn little from the edge's own. What turns by
  // more, though less than at sharp edges, is mostly another face, such as the rounding beside a plane.
  Vec3 normal_at_end(Vertex v, const EdgeFacets& edge) const {
    const double least = cosine_of_degrees(most_turn_of_arcs);
    const Vec3 own = normal_at(edge);
    Vec3 sum;
    for (const Vec3& part : normals_.at({v, patch_[edge.facets[0]]})) {
      const double cosine = dot(unit(part), own);
      if (std::abs(cosine) > least) sum += cosine < 0 ? -part : part;
    }
    return norm(sum) > 0 ? unit(sum) : own;
  }

  // An arc in the plane of the chord and the normals' mean, which it meets at right angles at both ends.
  Vec3 bend_of_face(const EdgeFacets& edge) const {
    const Vec3 one = normal_at_end(edge.a, edge), two = normal_at_end(edge.b, edge);
    const Vec3 chord = at(edge.b) - at(edge.a);
    const double length = norm(chord);
    const double sine = dot(two - one, chord) / (2 * length);
    const Vec3 outward = (one + two) - chord * (dot(one + two, chord) / (length * length));
    return unit(outward) * height_over_middle(length, sine);
  }

  // The unit tangent of the curve at v, which is the circle through v and its neighbours; towards `next`.
  std::optional<Vec3> tangent_at(Vertex v, Vertex next) const {
    const std::vector<Vertex>& ends = sharp_ends_.at(v);
    if (ends.size() != 2) return std::nullopt;
    const Vertex last = ends[0] == next ? ends[1] : ends[0];
    const Vec3 one = at(v) - at(last), two = at(next) - at(v);
    if (dot(unit(one), unit(two)) < cosine_of_degrees(default_feature_angle)) return std::nullopt;
    return unit((1 / norm_squared(one)) * one + (1 / norm_squared(two)) * two);
  }

  Vec3 bend_of_curve(const EdgeFacets& edge) const {
    const auto begin = tangent_at(edge.a, edge.b);
    auto end = tangent_at(edge.b, edge.a);
    if (end) end = -*end;
    if (!begin && !end) return {};
    const Vec3 chord = at(edge.b) - at(edge.a);
    const double length = norm(chord);
    const Vec3 along = (1 / length) * chord;
    // Where the curve begins or ends, the arc is symmetric.
    const auto sideways = [&](const Vec3& tangent) { return tangent - along * dot(tangent, along); };
    const Vec3 out = begin && end ? 0.5 * (sideways(*begin) - sideways(*end))
                     : begin      ? sideways(*begin)
                                  : -1.0 * sideways(*end);
    return unit(out) * height_over_middle(length, norm(out));
  }

  const MixedMesh& mesh_;
  std::vector<Facet> facets_;
  std::vector<std::int32_t> tags_;  // by facet
  std::map<VertexKey<2>, EdgeFacets> edges_;
  std::map<Vertex, std::vector<Vertex>> sharp_ends_;
  std::vector<std::int32_t> patch_;  // by facet: one number for all that are joined without a sharp edge between
  std::map<std::pair<Vertex, std::int32_t>, std::vector<Vec3>> normals_;  // by vertex and patch
};

}  // namespace

std::vector<BoundaryEdge> boundary_edges(const MixedMesh& mesh) {
  return EdgeFinder(mesh).run();
}

}  // namespace hexpipe::assemble::order
