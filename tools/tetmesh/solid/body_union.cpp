// Apart from the others because it includes CGAL's polygon mesh processing,
// which takes long to compile and is under the GPL.

#include "tools/tetmesh/solid/body_union.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/joined_sets.hpp"
#include "common/run/error.hpp"
#include "formats/surfaces/surface_building.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/solid/borders.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

using formats::SurfaceSoup;
using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_exact_constructions_kernel::Point_3>;
using Triangles = std::vector<std::int32_t>;

constexpr std::size_t most_intersections = 10'000'000;

class Uniter {
 public:
  explicit Uniter(SurfaceSoup& soup) : soup_(soup) {}

  std::size_t unite() {
    find_bodies();
    const auto groups = groups_of_bodies();
    if (groups.empty()) return 0;
    std::vector<bool> kept(soup_.triangles.size(), true);
    SurfaceSoup joined;
    std::size_t count = 0;
    for (const auto& bodies : groups) {
      for (const std::int32_t body : bodies)
        for (const std::int32_t t : bodies_.at(body)) kept[t] = false;
      append(union_of(bodies), bodies, joined);
      count += bodies.size();
    }
    keep_only(soup_, kept);
    const auto first = static_cast<Vertex>(soup_.points.size());
    soup_.points.insert(soup_.points.end(), joined.points.begin(), joined.points.end());
    for (std::size_t t = 0; t < joined.triangles.size(); ++t) {
      Triangle corners = joined.triangles[t];
      for (Vertex& v : corners) v += first;
      formats::append_triangle(soup_, corners, joined.tags[t], joined.places[t]);
    }
    soup_ = formats::merge_equal_points(std::move(soup_));
    return count;
  }

 private:
  // Bodies hang together by edges.
  void find_bodies() {
    JoinedSets sets(soup_.triangles.size());
    geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const geometry::HalfEdge> edge) {
      for (const geometry::HalfEdge h : edge) sets.join(geometry::triangle_of(edge[0]), geometry::triangle_of(h));
    });
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(soup_.triangles.size()); ++t) {
      body_of_.push_back(sets.of(t));
      bodies_[sets.of(t)].push_back(t);
    }
  }

  // Each of two bodies or more.
  std::vector<std::vector<std::int32_t>> groups_of_bodies() const {
    const auto found = geometry::find_intersections(soup_.points, soup_.triangles, most_intersections);
    if (!found.complete)
      throw DataError::at(soup_.name,
                          "expected bodies that overlap, found more than {} "
                          "pairs of triangles that do",
                          most_intersections);
    JoinedSets sets(soup_.triangles.size());
    for (const auto& [t, u] : found.pairs) sets.join(body_of_[t], body_of_[u]);
    std::map<std::int32_t, std::vector<std::int32_t>> by_set;
    for (const auto& [body, triangles] : bodies_) by_set[sets.of(body)].push_back(body);
    std::vector<std::vector<std::int32_t>> groups;
    for (auto& [set, bodies] : by_set)
      if (bodies.size() > 1) groups.push_back(std::move(bodies));
    for (const auto& [t, u] : found.pairs)
      if (body_of_[t] == body_of_[u] && std::ranges::any_of(groups, [&](const auto& group) {
            return std::ranges::find(group, body_of_[t]) != group.end();
          }))
        throw DataError::at(soup_.place_of(static_cast<std::size_t>(t)),
                            "expected bodies that do not intersect themselves "
                            "for --unite, found one that does");
    return groups;
  }

  Mesh mesh_of(std::int32_t body) const {
    Mesh mesh;
    std::map<Vertex, Mesh::Vertex_index> vertices;
    double volume = 0;
    const Triangles& triangles = bodies_.at(body);
    const Vec3& origin = soup_.points[soup_.triangles[triangles.front()][0]];
    const auto refuse = [&](const char* found) {
      throw DataError::at(soup_.place_of(static_cast<std::size_t>(triangles.front())),
                          "expected closed bodies that point outward for --unite, found {}", found);
    };
    for (const std::int32_t t : triangles) {
      std::array<Mesh::Vertex_index, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vertex v = soup_.triangles[t][i];
        const auto [entry, is_new] = vertices.try_emplace(v);
        const Vec3& p = soup_.points[v];
        if (is_new) entry->second = mesh.add_vertex({p.x, p.y, p.z});
        corners[i] = entry->second;
      }
      if (mesh.add_face(corners[0], corners[1], corners[2]) == Mesh::null_face()) refuse("one that is none");
      const auto [a, b, c] = soup_.triangles[t];
      volume += det(soup_.points[a] - origin, soup_.points[b] - origin, soup_.points[c] - origin);
    }
    if (!CGAL::is_closed(mesh)) refuse("an open one");
    if (!(volume > 0)) refuse("one that points inward");
    return mesh;
  }

  Mesh union_of(std::span<const std::int32_t> bodies) const {
    Mesh all = mesh_of(bodies.front());
    for (const std::int32_t body : bodies.subspan(1)) {
      Mesh next = mesh_of(body), result;
      if (!CGAL::Polygon_mesh_processing::corefine_and_compute_union(all, next, result))
        throw DataError::at(soup_.place_of(static_cast<std::size_t>(bodies_.at(body).front())),
                            "expected bodies that overlap or are apart for --unite, found one "
                            "that touches others in an "
                            "edge or a vertex alone");
      all = std::move(result);
    }
    return all;
  }

  // With the tags and places of the old triangles.
  void append(const Mesh& mesh, std::span<const std::int32_t> bodies, SurfaceSoup& to) const {
    std::vector<Triangle> old;
    Triangles numbers;
    for (const std::int32_t body : bodies)
      for (const std::int32_t t : bodies_.at(body)) {
        old.push_back(soup_.triangles[t]);
        numbers.push_back(t);
      }
    const geometry::BoxTree tree = geometry::tree_of_triangles(soup_.points, old);
    const auto nearest_to = [&](const Vec3& p) {
      double least = std::numeric_limits<double>::max();
      std::int32_t nearest = 0;
      tree.least(p, 1, std::numeric_limits<double>::max(), [&](std::int32_t t) {
        const auto [a, b, c] = old[t];
        const geometry::TriangleDistance triangle(soup_.points[a], soup_.points[b], soup_.points[c]);
        const double distance = std::sqrt(triangle.squared(p));
        if (distance < least) least = distance, nearest = t;
        return distance;
      });
      return numbers[nearest];
    };
    const auto first = static_cast<Vertex>(to.points.size());
    std::vector<Vertex> number(mesh.num_vertices() + mesh.number_of_removed_vertices(), no_index);
    for (const auto v : mesh.vertices()) {
      const auto& p = mesh.point(v);
      number[v] = first + static_cast<Vertex>(to.points.size() - static_cast<std::size_t>(first));
      to.points.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
    }
    for (const auto f : mesh.faces()) {
      Triangle corners;
      std::size_t i = 0;
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) corners[i++] = number[v];
      const Vec3 centre = (to.points[corners[0]] + to.points[corners[1]] + to.points[corners[2]]) * (1.0 / 3);
      const std::int32_t t = nearest_to(centre);
      formats::append_triangle(to, corners, soup_.tags[t], soup_.places[t]);
    }
  }

  SurfaceSoup& soup_;
  std::vector<std::int32_t> body_of_;  // by triangle: the first triangle of its body
  std::map<std::int32_t, Triangles> bodies_;
};

}  // namespace

std::size_t unite_bodies(SurfaceSoup& soup) {
  for (const auto& [a, b, c] : soup.triangles)
    if (geometry::are_collinear(soup.points[a], soup.points[b], soup.points[c])) return 0;
  return Uniter(soup).unite();
}

}  // namespace hexpipe::tetmesh::solid
