#include "tools/assemble/gap/solids.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/mesh/item_lists.hpp"

namespace hexpipe::assemble::gap {
namespace {

// The place of the directed edge from a to b in the facet, or the facet's size.
std::size_t place_of_edge(const Facet& facet, Vertex a, Vertex b) {
  const auto corners = facet.vertices();
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (corners[i] == a && corners[(i + 1) % corners.size()] == b) return i;
  return corners.size();
}

// The vertex that an edge of the skin joins to v and that `base` does not have. A cell has only one.
Vertex beyond(std::span<const Facet> skin, const Facet& base, Vertex v) {
  for (const Facet& facet : skin) {
    const auto corners = facet.vertices();
    const auto at = static_cast<std::size_t>(std::ranges::find(corners, v) - corners.begin());
    if (at == corners.size()) continue;
    for (const std::size_t step : {std::size_t{1}, corners.size() - 1})
      if (const Vertex w = corners[(at + step) % corners.size()]; !base.has(w)) return w;
  }
  return no_index;
}

// The kind of a cell with so many facets and vertices.
std::optional<CellKind> kind_with(std::size_t quads, std::size_t triangles, std::size_t vertices) {
  for (const CellKind kind : {CellKind::tet, CellKind::pyramid, CellKind::prism, CellKind::hex}) {
    const bool fits = with_topology(kind, [&](auto topology) {
      using Topology = decltype(topology);
      return quads == Topology::quads.size() && triangles == Topology::triangles.size() &&
             vertices == static_cast<std::size_t>(Topology::corner_count);
    });
    if (fits) return kind;
  }
  return std::nullopt;
}

bool has_skin(const Solid& solid, std::span<const Facet> skin) {
  bool has_all = true;
  for_facets(solid.kind, solid.vertices(),
             [&](const Facet& facet) { has_all = has_all && std::ranges::find(skin, facet) != skin.end(); });
  return has_all;
}

// `base` is seen from outside, the first corners of a cell from inside.
Solid with_base(CellKind kind, const Facet& base) {
  Solid solid{kind, {}};
  const auto corners = base.vertices();
  std::ranges::reverse_copy(corners, solid.corners.begin());
  return solid;
}

}  // namespace

std::optional<Solid> solid_of(std::span<const Facet> skin) {
  std::vector<Vertex> vertices;
  for (const Facet& facet : skin) vertices.insert(vertices.end(), facet.vertices().begin(), facet.vertices().end());
  sort_unique(vertices);
  const auto quads = static_cast<std::size_t>(std::ranges::count_if(skin, &Facet::is_quad));
  const auto kind = kind_with(quads, skin.size() - quads, vertices.size());
  if (!kind) return std::nullopt;
  const bool stands_on_quad = *kind == CellKind::hex || *kind == CellKind::pyramid;
  const Facet& base =
      *std::ranges::find_if(skin, [&](const Facet& facet) { return facet.is_quad() == stands_on_quad; });
  Solid solid = with_base(*kind, base);
  const std::size_t below = base.vertices().size();
  for (std::size_t i = below; i < vertices.size(); ++i) solid.corners[i] = beyond(skin, base, solid.corners[i - below]);
  return has_skin(solid, skin) ? std::optional(solid) : std::nullopt;
}

std::optional<Solid> solid_on(std::span<const Facet> skin, const Facet& base) {
  const auto below = base.vertices();
  const std::size_t count = below.size();
  std::array<Vertex, 4> above{no_index, no_index, no_index, no_index};
  std::size_t sides = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    for (const Facet& side : skin) {
      const std::size_t at = side.is_quad() ? place_of_edge(side, below[next], below[i]) : 4;
      if (at == 4) continue;
      ++sides;
      for (const auto& [corner, top] :
           {std::pair{i, side.corners[(at + 2) % 4]}, std::pair{next, side.corners[(at + 3) % 4]}}) {
        if (above[corner] != no_index && above[corner] != top) return std::nullopt;
        above[corner] = top;
      }
    }
  }
  if (sides + 1 < count) return std::nullopt;
  Solid solid = with_base(count == 4 ? CellKind::hex : CellKind::prism, base);
  for (std::size_t i = 0; i < count; ++i) solid.corners[count + i] = above[count - 1 - i];
  std::vector<Vertex> all(solid.vertices().begin(), solid.vertices().end());
  sort_unique(all);
  if (all.size() < 2 * count || all.front() == no_index) return std::nullopt;
  return solid;
}

std::optional<std::vector<Facet>> skin_without(std::span<const Facet> skin, const Solid& solid) {
  std::vector<Facet> rest(skin.begin(), skin.end());
  bool fits = true;
  for_facets(solid.kind, solid.vertices(), [&](const Facet& facet) {
    const Facet reversed = facet.reversed();
    if (const auto own = std::ranges::find(rest, facet); own != rest.end())
      rest.erase(own);
    else if (std::ranges::find(rest, reversed) != rest.end())
      fits = false;
    else
      rest.push_back(reversed);
  });
  return fits ? std::optional(std::move(rest)) : std::nullopt;
}

std::vector<std::vector<Facet>> bodies_of(std::span<const Facet> skin) {
  std::vector<std::vector<Facet>> bodies;
  std::vector<Facet> rest(skin.begin(), skin.end());
  while (!rest.empty()) {
    std::vector<Facet> body{rest.back()};
    rest.pop_back();
    for (std::size_t i = 0; i < body.size(); ++i) {
      const Facet facet = body[i];
      const auto corners = facet.vertices();
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vertex a = corners[k], b = corners[(k + 1) % corners.size()];
        const auto is_across = [&](const Facet& other) { return place_of_edge(other, b, a) < other.vertices().size(); };
        std::ranges::copy_if(rest, std::back_inserter(body), is_across);
        std::erase_if(rest, is_across);
      }
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace hexpipe::assemble::gap
