#include "tools/wrap/shrink_wrap.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace hexpipe::wrap {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

std::vector<Kernel::Point_3> points_of(const Surface& surface) {
  std::vector<Kernel::Point_3> points;
  points.reserve(surface.points.size());
  for (const Vec3& p : surface.points) points.emplace_back(p.x, p.y, p.z);
  return points;
}

}  // namespace

Surface shrink_wrap(const Surface& surface, double alpha, double offset) {
  std::vector<std::array<std::size_t, 3>> triangles;
  triangles.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles)
    triangles.push_back({static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c)});
  Mesh mesh;
  CGAL::alpha_wrap_3(points_of(surface), triangles, alpha, offset, mesh);
  Surface result;
  result.points.reserve(mesh.number_of_vertices());
  std::vector<Vertex> number(mesh.num_vertices());
  for (const auto v : mesh.vertices()) {
    number[v] = static_cast<Vertex>(result.points.size());
    const auto& p = mesh.point(v);
    result.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    Triangle triangle{};
    std::size_t i = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) triangle[i++] = number[v];
    result.triangles.push_back(triangle);
  }
  return result;
}

std::vector<std::int32_t> crossing_triangles(const Surface& surface) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  for (const auto& p : points_of(surface)) vertices.push_back(mesh.add_vertex(p));
  std::vector<std::int32_t> triangle_of_face, crossing;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    // An edge that has two triangles already takes no more.
    const bool fits = mesh.add_face(vertices[a], vertices[b], vertices[c]) != Mesh::null_face();
    (fits ? triangle_of_face : crossing).push_back(static_cast<std::int32_t>(t));
  }
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
  for (const auto& [first, second] : pairs) {
    crossing.push_back(triangle_of_face[first]);
    crossing.push_back(triangle_of_face[second]);
  }
  std::sort(crossing.begin(), crossing.end());
  crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
  return crossing;
}

}  // namespace hexpipe::wrap
