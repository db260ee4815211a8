#include "tools/assemble/self_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/error.hpp"
#include "tools/assemble/hybrid/cell_facets.hpp"
#include "tools/assemble/shape/boundary_deviation.hpp"

namespace hexpipe::assemble {
namespace {

// A fraction of the input's volume. A million terms lose no more by rounding.
constexpr double volume_tolerance = 1e-9;
// A fraction of the bounding box's diagonal. Planes of surfaces written as floats are uneven by 1e-7, and vertices
// slide there.
constexpr double surface_tolerance = 1e-6;

template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) {
  throw DataError::at("self-check of the result", text, std::forward<Args>(args)...);
}

void check_cells_valid(const MixedMesh& mesh) {
  hybrid::for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners, std::int32_t) {
    const auto at = corner_points(mesh.points, corners);
    if (!is_valid(kind, std::span<const Vec3>(at).first(corners.size())))
      fail("expected valid cells, found an invalid {} at {} {} {}", name_of(kind), at[0].x, at[0].y, at[0].z);
  });
}

template <int Corners>
void mark_tagged(const CellBlock<Corners>& block, hybrid::CellFacets& table) {
  for (const auto& facet : block.cells) {
    hybrid::CellFacets::Entry* entry = table.find(hybrid::FacetForm::of(facet));
    if (entry == nullptr) fail("expected tagged facets of cells, found one at vertex {} of none", facet[0]);
    if (entry->tagged) fail("expected tagged facets once, found one at vertex {} twice", facet[0]);
    entry->tagged = true;
  }
}

// The quad as the entry's first cell goes around it.
Quad quad_of(const hybrid::CellFacets::Entry& entry) {
  const auto& [least, opposite, low, high] = entry.vertices;
  return entry.forward ? Quad{least, low, opposite, high} : Quad{least, high, opposite, low};
}

// How much further out the bilinear quad lies than its two triangles.
double bulge_of(std::span<const Vec3> points, const Quad& quad, int diagonal) {
  // Halfway between the two diagonals, which have a tet of this volume between them.
  const double half_tet = tet_determinant(points, quad) / 6 / 2;
  return diagonal == 0 ? half_tet : -half_tet;
}

// The diagonal along which two facets of one cell each lie under the quad; marks these as tagged.
std::optional<int> open_diagonal(const Quad& quad, hybrid::CellFacets& table) {
  for (int diagonal = 0; diagonal < 2; ++diagonal) {
    const auto halves = triangles_of(quad, diagonal);
    hybrid::CellFacets::Entry* first = table.find(hybrid::FacetForm::of(halves[0]));
    hybrid::CellFacets::Entry* second = table.find(hybrid::FacetForm::of(halves[1]));
    if (first == nullptr || second == nullptr || first->uses != 1 || second->uses != 1) continue;
    first->tagged = second->tagged = true;
    return diagonal;
  }
  return std::nullopt;
}

// Whether a cell has a triangle of three of the quad's corners. At the boundary it may be the other side of a thin
// slit, which the quad closes by half.
bool has_half_facet(const Quad& quad, hybrid::CellFacets& table) {
  for (int diagonal = 0; diagonal < 2; ++diagonal)
    for (const auto& half : triangles_of(quad, diagonal))
      if (table.find(hybrid::FacetForm::of(half)) != nullptr) return true;
  return false;
}

double volume_over(std::span<const Vec3> points, const Vec3& origin, const Triangle& t) {
  return det(points[t[0]] - origin, points[t[1]] - origin, points[t[2]] - origin) / 6;
}

// Between a bilinear quad and a point: the mean over both diagonals.
double volume_over(std::span<const Vec3> points, const Vec3& origin, const Quad& q) {
  double sum = 0;
  for (int diagonal = 0; diagonal < 2; ++diagonal)
    for (const auto& half : triangles_of(q, diagonal)) sum += volume_over(points, origin, half);
  return sum / 2;
}

// The volume inside the facets that only one cell has.
double skin_volume(const MixedMesh& mesh, hybrid::CellFacets& table) {
  double sum = 0;
  for (const auto& entry : table.entries()) {
    if (entry.uses != 1) continue;
    const auto& v = entry.vertices;
    const Triangle triangle = entry.forward ? Triangle{v[0], v[1], v[2]} : Triangle{v[0], v[2], v[1]};
    const Vec3& origin = mesh.points.front();
    sum +=
        entry.is_quad() ? volume_over(mesh.points, origin, quad_of(entry)) : volume_over(mesh.points, origin, triangle);
  }
  return sum;
}

// Judges every facet and sums the bulges.
void check_facets(const hybrid::Extract& result, const hybrid::SurfaceTags& tags, bool conforming,
                  hybrid::CellFacets& table, CheckedVolumes& volumes) {
  const MixedMesh& mesh = result.mesh;
  mark_tagged(mesh.triangles, table);
  mark_tagged(mesh.quads, table);
  for (auto& entry : table.entries()) {
    const Vertex at = entry.vertices[0];
    if (entry.uses > 2 || entry.one_way) fail("expected one cell on each side of a facet, found more at vertex {}", at);
    if (entry.uses == 2 && entry.regions[0] != entry.regions[1] && !entry.tagged)
      fail("expected interfaces to be tagged, found one at vertex {} that is not", at);
    if (entry.uses == 2 || !entry.is_quad()) continue;
    const Quad quad = quad_of(entry);
    // This comes first, because an interface quad can be both tagged and open.
    if (const auto diagonal = conforming ? std::nullopt : open_diagonal(quad, table)) {
      volumes.open_bulge += bulge_of(mesh.points, quad, *diagonal);
      ++volumes.nonconforming_quads;
      entry.tagged = true;
      continue;
    }
    if (!entry.tagged) fail("expected cells on both sides of a quad, found one at vertex {} with one side", at);
    if (conforming && has_half_facet(quad, table))
      fail("expected no triangle on half of a quad, found one at vertex {}", at);
    Quad input_quad;
    for (int i = 0; i < 4; ++i) input_quad[i] = result.origin[quad[i]];
    volumes.bulge += bulge_of(mesh.points, quad, tags.cover_of(input_quad, 0) ? 0 : 1);
  }
  for (const auto& entry : table.entries())
    if (entry.uses == 1 && !entry.tagged)
      fail("expected boundary facets to be tagged, found one at vertex {} that is not", entry.vertices[0]);
}

void check_points_used(const MixedMesh& mesh) {
  std::vector<bool> used(mesh.points.size());
  hybrid::for_each_cell(mesh, [&](CellKind, std::span<const Vertex> corners, std::int32_t) {
    for (Vertex v : corners) used[v] = true;
  });
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v]) fail("expected cells at every vertex, found none at vertex {}", v);
}

// Vertices of the boundary are the input's.
void check_origins(const MixedMesh& mesh, std::span<const Vertex> origin, const TetMesh& input) {
  auto check = [&](const auto& block) {
    for (const auto& facet : block.cells)
      for (Vertex v : facet)
        if (origin[v] < 0 || static_cast<std::size_t>(origin[v]) >= input.points.size())
          fail("expected the input's vertices on the boundary, found vertex {}", v);
  };
  check(mesh.triangles);
  check(mesh.quads);
}

void check_on_surface(const shape::BoundaryDeviation& deviation, const shape::InputSurface& surface) {
  if (const auto v = deviation.vertex_off_surface(surface_tolerance * surface.diagonal()))
    fail("expected the boundary's vertices on the input's surface, found vertex {} off it", *v);
}

// Both, and how far the boundary is from the surface.
void check_surface(const hybrid::Extract& result, const TetMesh& input, const shape::InputSurface& surface,
                   CheckedVolumes& volumes) {
  check_origins(result.mesh, result.origin, input);
  const shape::BoundaryDeviation deviation(result.mesh, surface, input.points, result.origin);
  check_on_surface(deviation, surface);
  const auto summary = deviation.summary();
  volumes.deviation = summary.greatest;
  volumes.moved = summary.moved;
}

double volume_of(std::span<const Vec3> points, std::span<const Tet> tets) {
  double sum = 0;
  for (const auto& tet : tets) sum += tet_determinant(points, tet) / 6;
  return sum;
}

// The present places of the input's vertices. Vertices inside that are gone do not matter in the sum over all tets.
std::vector<Vec3> moved_input_points(const hybrid::Extract& result, const TetMesh& input) {
  std::vector<Vec3> points = input.points;
  for (std::size_t v = 0; v < result.origin.size(); ++v)
    if (static_cast<std::size_t>(result.origin[v]) < points.size()) points[result.origin[v]] = result.mesh.points[v];
  return points;
}

void check_volumes(const CheckedVolumes& volumes) {
  if (!(std::abs(volumes.skin - volumes.cells) <= volume_tolerance * volumes.input))
    fail("expected the volume of the cells, {}, inside the skin, found {}", volumes.cells, volumes.skin);
  if (!(std::abs(volumes.drift) <= volume_tolerance * volumes.input))
    fail("expected a volume of {} with the bulges of quads, found {}", volumes.cells - volumes.drift, volumes.cells);
}

}  // namespace

namespace {

double area_of_facets(const MixedMesh& mesh) {
  const auto area = [&](const Triangle& t) {
    return norm(cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]])) / 2;
  };
  double sum = 0;
  for (const Triangle& triangle : mesh.triangles.cells) sum += area(triangle);
  for (const Quad& quad : mesh.quads.cells)
    for (const Triangle& half : triangles_of(quad, 0)) sum += area(half);
  return sum;
}

// `slack`: the volume by which the boundary may have moved.
void check_regions(const RegionVolumes& before, const RegionVolumes& now, double slack) {
  for (const auto& [region, volume] : now)
    if (const auto was = before.find(region);
        was == before.end() || !(std::abs(volume - was->second) <= volume_tolerance * volume + slack))
      fail("expected a volume of {} in region {}, within {}, as before the layers, found {}",
           was == before.end() ? 0 : was->second, region, slack, volume);
  if (before.size() != now.size())
    fail("expected {} regions, as before the layers, found {}", before.size(), now.size());
}

}  // namespace

RegionVolumes region_volumes(const MixedMesh& mesh) {
  RegionVolumes volumes;
  hybrid::for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners, std::int32_t region) {
    volumes[region] +=
        cell_volume(kind, std::span<const Vec3>(corner_points(mesh.points, corners)).first(corners.size()));
  });
  return volumes;
}

double check_layered(const MixedMesh& mesh, std::span<const Vertex> origin, const TetMesh& input,
                     const shape::InputSurface& surface, const BeforeLayers& before) {
  check_cells_valid(mesh);
  check_points_used(mesh);
  hybrid::CellFacets table(mesh);
  mark_tagged(mesh.triangles, table);
  mark_tagged(mesh.quads, table);
  for (const auto& entry : table.entries()) {
    const Vertex at = entry.vertices[0];
    if (entry.uses > 2 || entry.one_way) fail("expected one cell on each side of a facet, found more at vertex {}", at);
    const bool is_outer = entry.uses == 1, is_interface = !is_outer && entry.regions[0] != entry.regions[1];
    if ((is_outer || is_interface) && !entry.tagged)
      fail("expected facets of the boundary and of interfaces to be tagged, found one at vertex {} that is not", at);
    if (is_outer && entry.is_quad() && has_half_facet(quad_of(entry), table))
      fail("expected no triangle on half of a quad, found one at vertex {}", at);
  }
  check_origins(mesh, origin, input);
  check_on_surface(shape::BoundaryDeviation(mesh, surface, input.points, origin), surface);
  double deviation = 0;
  const auto measure = [&](const auto& block) {
    for (const auto& facet : block.cells) {
      Vec3 middle{};
      for (const Vertex v : facet) middle += mesh.points[v] * (1.0 / static_cast<double>(facet.size()));
      deviation = std::max(deviation, surface.distance(origin[facet[0]], middle));
    }
  };
  measure(mesh.triangles);
  measure(mesh.quads);
  const RegionVolumes volumes = region_volumes(mesh);
  double volume = 0;
  for (const auto& [region, of_region] : volumes) volume += of_region;
  // Twice: the middle of a facet need not be the place that is furthest off.
  check_regions(before.volumes, volumes, 2 * (before.deviation + deviation) * area_of_facets(mesh));
  const double skin = skin_volume(mesh, table);
  if (!(std::abs(skin - volume) <= volume_tolerance * volume))
    fail("expected the volume of the cells, {}, inside the skin, found {}", volume, skin);
  return deviation;
}

CheckedVolumes check_result(const hybrid::Extract& result, const TetMesh& input, const hybrid::SurfaceTags& tags,
                            const shape::InputSurface& surface, bool conforming) {
  const MixedMesh& mesh = result.mesh;
  CheckedVolumes volumes;
  check_cells_valid(mesh);
  check_points_used(mesh);
  hybrid::CellFacets table(mesh);
  check_facets(result, tags, conforming, table, volumes);
  check_surface(result, input, surface, volumes);
  volumes.skin = skin_volume(mesh, table);
  hybrid::for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners, std::int32_t) {
    volumes.cells +=
        cell_volume(kind, std::span<const Vec3>(corner_points(mesh.points, corners)).first(corners.size()));
  });
  volumes.input = volume_of(input.points, input.tets);
  const auto moved = moved_input_points(result, input);
  volumes.slide = volume_of(moved, input.tets) - volumes.input;
  volumes.peeled = volume_of(moved, tags.peeled());
  volumes.drift = volumes.cells - volumes.input - volumes.bulge - volumes.open_bulge - volumes.slide + volumes.peeled;
  check_volumes(volumes);
  return volumes;
}

}  // namespace hexpipe::assemble
