#include "tools/wrap/open_sheets.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace hexpipe::wrap {
namespace {

using Edge = std::pair<Vertex, Vertex>;

// For each point the first one at the same place.
std::vector<Vertex> first_at_place(const std::vector<Vec3>& points) {
  std::map<std::tuple<double, double, double>, Vertex> first;
  std::vector<Vertex> result;
  result.reserve(points.size());
  for (std::size_t v = 0; v < points.size(); ++v)
    result.push_back(first.try_emplace({points[v].x, points[v].y, points[v].z}, static_cast<Vertex>(v)).first->second);
  return result;
}

// Edges that an odd number of triangles have, each with its last triangle.
std::map<Edge, std::size_t> open_edges(const Surface& surface) {
  const std::vector<Vertex> place = first_at_place(surface.points);
  std::map<Edge, std::size_t> open;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& corners = surface.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge = std::minmax(place[corners[i]], place[corners[(i + 1) % 3]]);
      if (edge.first == edge.second) continue;
      if (!open.try_emplace(edge, t).second) open.erase(edge);
    }
  }
  return open;
}

// Takes the edges of a ring out of `at`, the open edges at each point, and returns its points in order.
std::vector<Vertex> take_ring(Vertex start, std::map<Vertex, std::vector<Vertex>>& at) {
  std::vector<Vertex> ring{start};
  for (Vertex v = start; !at[v].empty();) {
    const Vertex next = at[v].back();
    at[v].pop_back();
    std::erase(at[next], v);
    if (next == start) break;
    ring.push_back(next);
    v = next;
  }
  return ring;
}

Hole measure(const std::vector<Vertex>& ring, const std::vector<Vec3>& points) {
  Hole hole{{}, 0, ring.size()};
  for (const Vertex v : ring) hole.middle += (1.0 / static_cast<double>(ring.size())) * points[v];
  Vec3 area;
  double perimeter = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 &p = points[ring[i]], &q = points[ring[(i + 1) % ring.size()]];
    area += 0.5 * cross(p - hole.middle, q - hole.middle);
    perimeter += norm(q - p);
  }
  if (perimeter > 0) hole.width = 4 * norm(area) / perimeter;
  return hole;
}

}  // namespace

Sheets find_sheets(const Surface& wrapped, const TriangleTree& input, std::size_t count, double offset) {
  const TriangleTree tree(wrapped);
  double area = 0, doubled = 0;
  std::vector<double> excess(count);  // of doubled area, near each triangle of the input
  for (const auto& [a, b, c] : wrapped.triangles) {
    const Vec3 &p = wrapped.points[a], &q = wrapped.points[b], &r = wrapped.points[c];
    const Vec3 middle = (1.0 / 3) * (p + q + r);
    const NearestPoint on_input = input.nearest(middle);
    // Farther out it spans a gap or rounds an inner edge.
    if (norm(on_input.point - middle) > 1.5 * offset) continue;
    const double share = norm(cross(q - p, r - p)) / 2;
    const bool is_double = tree.distance(2 * on_input.point - middle) < 0.5 * offset;
    area += share;
    if (is_double) doubled += share;
    excess[on_input.triangle] += is_double ? share : -share;
  }
  Sheets sheets;
  if (area > 0) sheets.share = doubled / area;
  for (const double of_triangle : excess) sheets.is_sheet.push_back(of_triangle > 0);
  return sheets;
}

std::optional<Hole> widest_hole(const Surface& surface) {
  const auto open = open_edges(surface);
  std::map<Vertex, std::vector<Vertex>> at;
  for (const auto& [edge, triangle] : open) {
    at[edge.first].push_back(edge.second);
    at[edge.second].push_back(edge.first);
  }
  std::optional<Hole> widest;
  for (const auto& [edge, triangle] : open) {
    const std::vector<Vertex> ring = take_ring(edge.first, at);
    const bool is_hole = ring.size() > 3 || [&] {
      // A triangle in the air has three open edges, too.
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto found = open.find(std::minmax(ring[i], ring[(i + 1) % ring.size()]));
        if (found != open.end() && found->second != triangle) return true;
      }
      return false;
    }();
    if (!is_hole) continue;
    const Hole hole = measure(ring, surface.points);
    if (!widest || hole.width > widest->width) widest = hole;
  }
  return widest;
}

}  // namespace hexpipe::wrap
