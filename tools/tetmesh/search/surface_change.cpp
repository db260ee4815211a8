#include "tools/tetmesh/search/surface_change.hpp"

#include <algorithm>
#include <array>

namespace hexpipe::tetmesh::search {
namespace {

constexpr double least_area = 0.05;  // of a triangle, in squares of the size
// Between the normals of one face. CAD files need less; the rest is a reserve for rounding.
constexpr double flat_sine = 1e-9;
constexpr double straight_sine = 1e-9;

Vertex third_corner(const Triangle& t, Vertex a, Vertex b) {
  return t[0] != a && t[0] != b ? t[0] : t[1] != a && t[1] != b ? t[1] : t[2];
}

}  // namespace

FlatSurface::FlatSurface(const solid::Surface& surface)
    : surface_(surface), triangles_(triangles_at_vertices(surface.points.size(), surface.triangles)) {}

std::vector<Vertex> FlatSurface::neighbours_of(Vertex v) const {
  std::vector<Vertex> neighbours;
  for (const std::int32_t t : triangles_.at(v))
    for (const Vertex w : surface_.triangles[t])
      if (w != v) neighbours.push_back(w);
  std::ranges::sort(neighbours);
  const auto repeated = std::ranges::unique(neighbours);
  neighbours.erase(repeated.begin(), repeated.end());
  return neighbours;
}

std::vector<std::int32_t> FlatSurface::triangles_of_edge(Vertex a, Vertex b) const {
  std::vector<std::int32_t> found;
  for (const std::int32_t t : triangles_.at(a))
    if (std::ranges::find(surface_.triangles[t], b) != surface_.triangles[t].end()) found.push_back(t);
  return found;
}

Vec3 FlatSurface::normal_of(const Triangle& t) const {
  const Vec3& a = surface_.points[t[0]];
  return cross(surface_.points[t[1]] - a, surface_.points[t[2]] - a);
}

bool FlatSurface::is_of_one_face(std::int32_t t, std::int32_t u) const {
  if (surface_.tags[t] != surface_.tags[u] || surface_.shell_of[t] != surface_.shell_of[u]) return false;
  const Vec3 one = unit(normal_of(surface_.triangles[t])), other = unit(normal_of(surface_.triangles[u]));
  return dot(one, other) > 0 && norm_squared(cross(one, other)) <= flat_sine * flat_sine;
}

FlatSurface::Freedom FlatSurface::freedom_of(Vertex v) const {
  std::vector<Vertex> creases;
  for (const Vertex w : neighbours_of(v)) {
    const std::vector<std::int32_t> beside = triangles_of_edge(v, w);
    if (beside.size() != 2) return {};
    if (!is_of_one_face(beside[0], beside[1])) creases.push_back(w);
  }
  if (creases.empty()) return {2, unit(normal_of(surface_.triangles[triangles_.at(v)[0]])), {}};
  if (creases.size() != 2) return {};
  const Vec3 to_one = unit(surface_.points[creases[0]] - surface_.points[v]);
  const Vec3 to_other = unit(surface_.points[creases[1]] - surface_.points[v]);
  if (dot(to_one, to_other) > 0 || norm_squared(cross(to_one, to_other)) > straight_sine * straight_sine) return {};
  return {1, unit(to_one - to_other), {creases[0], creases[1]}};
}

// Whether the triangle may become the one with these corners.
bool FlatSurface::keeps(std::int32_t triangle, const Vec3& a, const Vec3& b, const Vec3& c, double size) const {
  const Vec3 twice_area = cross(b - a, c - a);
  return dot(twice_area, unit(normal_of(surface_.triangles[triangle]))) > 2 * least_area * size * size;
}

SurfaceChange FlatSurface::move(Vertex v, const Vec3& step, double size) const {
  const Freedom freedom = freedom_of(v);
  if (freedom.dimensions == 0) return {};
  const Vec3 along = dot(step, freedom.direction) * freedom.direction;
  const Vec3 place = surface_.points[v] + (freedom.dimensions == 1 ? along : step - along);
  for (const std::int32_t t : triangles_.at(v)) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex w = surface_.triangles[t][i];
      corners[i] = w == v ? place : surface_.points[w];
    }
    if (!keeps(t, corners[0], corners[1], corners[2], size)) return {};
  }
  SurfaceChange change;
  change.moved = {v, place};
  return change;
}

SurfaceChange FlatSurface::collapse(Vertex v, Vertex to, double size) const {
  const Freedom freedom = freedom_of(v);
  if (freedom.dimensions == 0) return {};
  if (freedom.dimensions == 1 && to != freedom.along.first && to != freedom.along.second) return {};
  // Exactly two vertices must be joined to both ends; otherwise the triangles around would be folded onto each other.
  const std::vector<Vertex> of_v = neighbours_of(v), of_other = neighbours_of(to);
  std::vector<Vertex> common;
  std::ranges::set_intersection(of_v, of_other, std::back_inserter(common));
  if (common.size() != 2) return {};
  SurfaceChange change;
  change.removed = v;
  for (const std::int32_t t : triangles_.at(v)) {
    Triangle corners = surface_.triangles[t];
    change.removed_triangles.push_back(t);
    if (std::ranges::find(corners, to) != corners.end()) continue;
    std::ranges::replace(corners, v, to);
    const auto& points = surface_.points;
    if (!keeps(t, points[corners[0]], points[corners[1]], points[corners[2]], size)) return {};
    change.added_triangles.push_back({corners, t});
  }
  return change;
}

SurfaceChange FlatSurface::split(Vertex a, Vertex b, double size) const {
  const std::vector<std::int32_t> beside = triangles_of_edge(a, b);
  if (beside.size() != 2) return {};
  const Vec3 middle = 0.5 * (surface_.points[a] + surface_.points[b]);
  SurfaceChange change;
  change.added = middle;
  change.removed_triangles = beside;
  for (const std::int32_t t : beside)
    for (const Vertex end : {a, b}) {
      Triangle corners = surface_.triangles[t];
      std::array<Vec3, 3> places;
      for (std::size_t i = 0; i < 3; ++i) {
        places[i] = corners[i] == end ? middle : surface_.points[corners[i]];
        if (corners[i] == end) corners[i] = no_index;
      }
      if (!keeps(t, places[0], places[1], places[2], size)) return {};
      change.added_triangles.push_back({corners, t});
    }
  return change;
}

SurfaceChange FlatSurface::flip(Vertex a, Vertex b, double size) const {
  const std::vector<std::int32_t> beside = triangles_of_edge(a, b);
  if (beside.size() != 2 || !is_of_one_face(beside[0], beside[1])) return {};
  const Vertex c = third_corner(surface_.triangles[beside[0]], a, b);
  const Vertex d = third_corner(surface_.triangles[beside[1]], a, b);
  if (!triangles_of_edge(c, d).empty()) return {};
  SurfaceChange change;
  change.removed_triangles = beside;
  // The first triangle gets d in place of b, the second one c in place of a.
  for (const auto& [t, from, to] : {std::tuple{beside[0], b, d}, std::tuple{beside[1], a, c}}) {
    Triangle corners = surface_.triangles[t];
    std::ranges::replace(corners, from, to);
    const auto& points = surface_.points;
    if (!keeps(t, points[corners[0]], points[corners[1]], points[corners[2]], size)) return {};
    change.added_triangles.push_back({corners, t});
  }
  return change;
}

solid::Surface with_changes(const solid::Surface& surface, std::span<const SurfaceChange* const> changes) {
  formats::SurfaceSoup soup = surface;
  std::vector<bool> gone(soup.points.size());
  std::vector<bool> replaced(soup.triangles.size());
  std::vector<std::pair<Triangle, std::int32_t>> triangles;  // with the triangle that each replaces
  std::vector<Vec3> added;
  for (const SurfaceChange* change : changes) {
    if (change->moved) soup.points[change->moved->first] = change->moved->second;
    if (change->removed) gone[*change->removed] = true;
    for (const std::int32_t t : change->removed_triangles) replaced[t] = true;
    for (const NewTriangle& t : change->added_triangles) {
      Triangle corners = t.corners;
      std::ranges::replace(corners, no_index, static_cast<Vertex>(soup.points.size() + added.size()));
      triangles.emplace_back(corners, t.instead_of);
    }
    if (change->added) added.push_back(*change->added);
  }
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    if (!replaced[t]) triangles.emplace_back(soup.triangles[t], static_cast<std::int32_t>(t));
  // Triangles of a shell stay together and in their place.
  std::ranges::stable_sort(triangles, {}, [](const auto& t) { return t.second; });

  gone.resize(soup.points.size() + added.size());
  soup.points.insert(soup.points.end(), added.begin(), added.end());
  std::vector<Vertex> new_number(soup.points.size());
  std::size_t kept = 0;
  for (std::size_t v = 0; v < soup.points.size(); ++v) {
    if (gone[v]) continue;
    new_number[v] = static_cast<Vertex>(kept);
    soup.points[kept++] = soup.points[v];
  }
  soup.points.resize(kept);
  soup.triangles.clear();
  soup.tags.clear();
  soup.places.clear();
  soup.file_vertices.clear();
  std::vector<std::int32_t> shell_of;
  for (auto& [corners, instead_of] : triangles) {
    for (Vertex& v : corners) v = new_number[v];
    soup.triangles.push_back(corners);
    soup.tags.push_back(surface.tags[instead_of]);
    soup.places.push_back(surface.places[instead_of]);
    shell_of.push_back(surface.shell_of[instead_of]);
  }
  return solid::with_shells_of(surface, std::move(soup), std::move(shell_of));
}

}  // namespace hexpipe::tetmesh::search
