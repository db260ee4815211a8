#include "tools/assemble/shape/boundary_deviation.hpp"

#include <algorithm>
#include <limits>

#include "common/mesh/facet_key.hpp"
#include "tools/assemble/shape/nearest_points.hpp"

namespace hexpipe::assemble::shape {

BoundaryDeviation::BoundaryDeviation(const MixedMesh& mesh, const InputSurface& surface,
                                     std::span<const Vec3> input_points, std::span<const Vertex> origin)
    : mesh_(mesh),
      surface_(surface),
      input_points_(input_points),
      origin_(origin),
      facets_(mesh.points.size(), [&](auto&& visit) {
        const auto triangles = static_cast<std::int32_t>(mesh.triangles.size());
        for (std::int32_t i = 0; i < triangles; ++i)
          for (Vertex v : mesh.triangles.cells[i]) visit(v, i);
        for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.quads.size()); ++i)
          for (Vertex v : mesh.quads.cells[i]) visit(v, triangles + i);
      }) {}

Quad BoundaryDeviation::facet(std::int32_t f) const {
  const auto triangles = static_cast<std::int32_t>(mesh_.triangles.size());
  if (f >= triangles) return mesh_.quads.cells[f - triangles];
  const auto& [a, b, c] = mesh_.triangles.cells[f];
  return {a, b, c, c};
}

double BoundaryDeviation::from_facet(std::int32_t f, double enough) const {
  const Quad corners = facet(f);
  const std::size_t count = corners[3] == corners[2] ? 3 : 4;
  auto at = [&](std::size_t i) { return mesh_.points[corners[i % count]]; };
  // Each corner is a start; the nearest that any finds counts.
  auto distance = [&](const Vec3& point) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count && least > enough; ++i)
      least = std::min(least, surface_.distance(origin_[corners[i]], point, enough));
    return least;
  };
  Vec3 middle{};
  // Where tets were peeled off the boundary, facets are not the input's.
  bool moved = count == 3 && !surface_.has_triangle({origin_[corners[0]], origin_[corners[1]], origin_[corners[2]]});
  double greatest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    middle += at(i) * (1.0 / static_cast<double>(count));
    // Edges between vertices that have not moved are edges of the input, and so are triangles.
    if (!moved && !has_moved(corners[i]) && !has_moved(corners[(i + 1) % count])) continue;
    moved = true;
    greatest = std::max(greatest, distance((at(i) + at(i + 1)) * 0.5));
  }
  return moved || count == 4 ? std::max(greatest, distance(middle)) : 0;
}

double BoundaryDeviation::to_facets_at(Vertex v, const Vec3& from) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::int32_t f : facets_.at(v)) {
    const Quad corners = facet(f);
    for (int diagonal = 0; diagonal < (corners[3] == corners[2] ? 1 : 2); ++diagonal)
      for (const auto& [a, b, c] : triangles_of(corners, diagonal)) {
        if (b == c) continue;  // the second one of a triangle
        const std::array triangle{mesh_.points[a], mesh_.points[b], mesh_.points[c]};
        if (is_surely_farther(triangle, from, least * least)) continue;
        const Vec3 at = nearest_on_triangle(triangle, from);
        least = std::min(least, norm(at - from));
      }
  }
  return least;
}

// The distance to the facets at v and, if v has slid further than that, to the facets at its neighbours.
double BoundaryDeviation::from_input_vertex(Vertex v, double enough) const {
  const Vec3 was = input_points_[origin_[v]];
  double least = to_facets_at(v, was);
  if (least <= enough) return least;
  std::vector<Vertex> seen{v};  // neighbours belong to two facets or more
  for (std::int32_t f : facets_.at(v))
    for (Vertex neighbour : facet(f)) {
      if (least <= enough || std::ranges::find(seen, neighbour) != seen.end()) continue;
      seen.push_back(neighbour);
      least = std::min(least, to_facets_at(neighbour, was));
    }
  return least;
}

double BoundaryDeviation::around(Vertex v, double enough, double most) const {
  double greatest = 0;
  std::vector<Vertex> seen;  // v belongs to all facets, its neighbours to two or more
  for (std::int32_t f : facets_.at(v)) {
    greatest = std::max(greatest, from_facet(f, enough));
    if (greatest > most) return greatest;
    for (Vertex corner : facet(f)) {
      if (!has_moved(corner) || std::ranges::find(seen, corner) != seen.end()) continue;
      seen.push_back(corner);
      greatest = std::max(greatest, from_input_vertex(corner, enough));
    }
    if (greatest > most) return greatest;
  }
  return greatest;
}

BoundaryDeviation::Summary BoundaryDeviation::summary() const {
  Summary summary;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(mesh_.triangles.size() + mesh_.quads.size()); ++f)
    summary.greatest = std::max(summary.greatest, from_facet(f, 0));
  for (Vertex v = 0; v < static_cast<Vertex>(mesh_.points.size()); ++v) {
    if (facets_.at(v).empty() || !has_moved(v)) continue;
    ++summary.moved;
    summary.greatest = std::max(summary.greatest, from_input_vertex(v, 0));
  }
  return summary;
}

std::optional<Vertex> BoundaryDeviation::vertex_off_surface(double tolerance) const {
  for (Vertex v = 0; v < static_cast<Vertex>(mesh_.points.size()); ++v) {
    if (facets_.at(v).empty() || !has_moved(v)) continue;
    const Vec3 at = mesh_.points[v];
    if (surface_.distance(origin_[v], at) > tolerance && surface_.distance(at) > tolerance) return v;
  }
  return std::nullopt;
}

}  // namespace hexpipe::assemble::shape
