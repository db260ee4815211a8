#include "tools/viewmesh/facets.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe::viewmesh {
namespace {

// Whether, begun at the least vertex, the next one is less than the one before: opposite senses differ in this.
std::uint8_t sense_of(const FacetCorners& facet) {
  const auto begin = facet.vertices.begin();
  const auto least = std::min_element(begin, begin + facet.count) - begin;
  const auto next = facet.vertices[(least + 1) % facet.count];
  const auto before = facet.vertices[(least + facet.count - 1) % facet.count];
  return next < before ? 0 : 1;
}

}  // namespace

int facet_count(CellKind kind) {
  return with_topology(kind, [](auto topology) {
    using Topology = decltype(topology);
    return static_cast<int>(Topology::triangles.size() + Topology::quads.size());
  });
}

FacetCorners facet_corners(const Scene& scene, std::int32_t cell, int facet) {
  const auto corners = scene.corners_of(cell);
  return with_topology(scene.kind_of(cell), [&](auto topology) {
    using Topology = decltype(topology);
    constexpr int triangles = static_cast<int>(Topology::triangles.size());
    FacetCorners result{{no_index, no_index, no_index, no_index}, facet < triangles ? 3 : 4};
    for (int i = 0; i < result.count; ++i) {
      if constexpr (Topology::triangles.size() > 0)
        if (facet < triangles) result.vertices[i] = corners[Topology::triangles[facet][i]];
      if constexpr (Topology::quads.size() > 0)
        if (facet >= triangles) result.vertices[i] = corners[Topology::quads[facet - triangles][i]];
    }
    return result;
  });
}

std::vector<FacetSide> facet_sides(const Scene& scene) {
  std::vector<FacetSide> sides;
  for (std::int32_t cell = 0; cell < scene.cell_count(); ++cell)
    for (int facet = 0; facet < facet_count(scene.kind_of(cell)); ++facet) {
      const FacetCorners corners = facet_corners(scene, cell, facet);
      FacetSide side{corners.vertices, cell, static_cast<std::uint8_t>(facet), sense_of(corners)};
      std::sort(side.key.begin(), side.key.end());
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end(),
            [](const FacetSide& a, const FacetSide& b) { return a.key != b.key ? a.key < b.key : a.cell < b.cell; });
  return sides;
}

std::vector<bool> surface_points(const Scene& scene) {
  std::vector<bool> result(scene.points.size());
  for_each_facet(facet_sides(scene), [&](std::span<const FacetSide> sides) {
    const auto beside_first = [&](const FacetSide& other) { return other.side == sides[0].side; };
    if (!std::all_of(sides.begin(), sides.end(), beside_first)) return;
    for (const std::int32_t vertex : sides[0].key)
      if (vertex != no_index) result[vertex] = true;
  });
  return result;
}

std::vector<std::uint8_t> layers_from_surface(const Scene& scene, const std::vector<bool>& surface) {
  constexpr int deepest = std::numeric_limits<std::uint8_t>::max();
  std::vector<std::uint8_t> depth(scene.points.size(), deepest);
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (surface[i]) depth[i] = 0;

  std::vector<std::uint8_t> layer(scene.cell_count(), deepest);
  std::vector<std::int32_t> left(scene.cell_count());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = static_cast<std::int32_t>(i);
  for (int reached = 0; reached + 1 < deepest && !left.empty(); ++reached) {
    const auto touches = [&](std::int32_t cell) {
      const auto corners = scene.corners_of(cell);
      return std::any_of(corners.begin(), corners.end(), [&](std::int32_t v) { return depth[v] == reached; });
    };
    const auto middle = std::partition(left.begin(), left.end(), [&](std::int32_t cell) { return !touches(cell); });
    if (middle == left.end()) break;
    for (auto cell = middle; cell != left.end(); ++cell) {
      layer[*cell] = static_cast<std::uint8_t>(reached + 1);
      for (const std::int32_t vertex : scene.corners_of(*cell))
        if (depth[vertex] == deepest) depth[vertex] = static_cast<std::uint8_t>(reached + 1);
    }
    left.erase(middle, left.end());
  }
  return layer;
}

}  // namespace hexpipe::viewmesh
