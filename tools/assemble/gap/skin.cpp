#include "tools/assemble/gap/skin.hpp"

#include <algorithm>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/item_lists.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// Worse cells may be replaced, but may not take the place of others: below this, the sign may be rounding.
constexpr double surely_valid = 1e-6;

// Extends a skin by one facet of what joins it: the two sides of a facet between both are gone.
void join(const GapMesh& gap, const Facet& facet, std::vector<Facet>& skin, Joining& joining) {
  if (!add_facet(facet, skin)) return;
  joining.touches = true;
  joining.crosses_tagged = joining.crosses_tagged || is_tagged(gap, facet);
}

}  // namespace

Facet Facet::of(std::span<const Vertex> corners) {
  Facet facet{{no_index, no_index, no_index, no_index}};
  const auto first = static_cast<std::size_t>(std::ranges::min_element(corners) - corners.begin());
  for (std::size_t i = 0; i < corners.size(); ++i) facet.corners[i] = corners[(first + i) % corners.size()];
  return facet;
}

Facet Facet::reversed() const {
  if (is_quad()) return {{corners[0], corners[3], corners[2], corners[1]}};
  return {{corners[0], corners[2], corners[1], no_index}};
}

bool add_facet(const Facet& facet, std::vector<Facet>& skin) {
  const auto twin = std::ranges::find(skin, facet.reversed());
  if (twin == skin.end()) {
    skin.push_back(facet);
    return false;
  }
  skin.erase(twin);
  return true;
}

Joining join_skin(const GapMesh& gap, const GapCell& cell, std::vector<Facet>& skin) {
  Joining joining;
  for_facets(cell.kind, cell.vertices(), [&](const Facet& facet) { join(gap, facet, skin, joining); });
  return joining;
}

Joining join_skin(const GapMesh& gap, std::span<const Facet> other, std::vector<Facet>& skin) {
  Joining joining;
  for (const Facet& facet : other) join(gap, facet, skin, joining);
  return joining;
}

bool is_tagged(const GapMesh& gap, const Facet& facet) {
  return !facet.is_quad() && gap.is_tagged({facet.corners[0], facet.corners[1], facet.corners[2]});
}

Vec3 middle_of(std::span<const Vec3> points, std::span<const Facet> skin) {
  Vec3 middle{};
  double corners = 0;
  for (const Facet& facet : skin)
    for (const Vertex v : facet.vertices()) middle += points[v], ++corners;
  return middle * (1 / corners);
}

std::optional<Room> room_of(const GapMesh& gap, std::span<const GapIndex> cells, std::size_t most_facets) {
  Room room;
  room.region = gap.cell(cells[0]).region;
  bool blocked = false;
  for (const GapIndex c : cells) {
    if (gap.cell(c).region != room.region) return std::nullopt;
    blocked = join_skin(gap, gap.cell(c), room.skin).crosses_tagged || blocked;
  }
  if (blocked || room.skin.size() > most_facets) return std::nullopt;
  for (const Facet& facet : room.skin)
    for (const Vertex v : facet.vertices()) room.vertices.push_back(v);
  sort_unique(room.vertices);
  for (const GapIndex c : cells)
    for (const Vertex v : gap.cell(c).vertices())
      if (!std::ranges::binary_search(room.vertices, v) && !gap.is_free(v)) return std::nullopt;
  return room;
}

std::optional<std::vector<Facet>> skin_of(const GapMesh& gap, KeptIndex kept) {
  const KeptCell& cell = gap.kept_cell(kept);
  std::vector<Facet> skin;
  bool is_whole = true;
  with_topology(cell.kind, [&](auto topology) {
    int i = 0;
    for (const auto& quad : decltype(topology)::quads) {
      const std::array<Vertex, 4> own{cell.corners[quad[0]], cell.corners[quad[1]], cell.corners[quad[2]],
                                      cell.corners[quad[3]]};
      const auto on_boundary = gap.boundary_triangles(kept, i);
      if (on_boundary) {
        for (const Triangle& triangle : *on_boundary) skin.push_back(Facet::of(triangle));
      } else {
        skin.push_back(Facet::of(own));
        is_whole = is_whole && gap.has_partner(kept, i);
      }
      ++i;
    }
    for (const auto& triangle : decltype(topology)::triangles)
      skin.push_back(
          Facet::of(std::array{cell.corners[triangle[0]], cell.corners[triangle[1]], cell.corners[triangle[2]]}));
  });
  if (!is_whole) return std::nullopt;
  return skin;
}

bool is_ball(std::span<const Facet> skin) {
  std::vector<VertexKey<2>> edges;
  for (const Facet& facet : skin) {
    const auto corners = facet.vertices();
    for (std::size_t i = 0; i < corners.size(); ++i)
      edges.push_back(edge_key(corners[i], corners[(i + 1) % corners.size()]));
  }
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size(); i += 2)
    if (i + 1 == edges.size() || edges[i] != edges[i + 1] || (i + 2 < edges.size() && edges[i + 2] == edges[i]))
      return false;
  return true;
}

std::vector<std::vector<GapIndex>> rooms_around(const GapMesh& gap, GapIndex c) {
  const GapCell& cell = gap.cell(c);
  std::vector<GapIndex> behind_facets{c}, at_edges{c};
  std::vector<std::vector<GapIndex>> rooms;
  for (const Vertex v : cell.vertices())
    for (const GapIndex other : gap.cells_at(v)) {
      if (std::ranges::find(at_edges, other) != at_edges.end()) continue;
      const int common = cell.count_common(gap.cell(other));
      if (common >= 2) at_edges.push_back(other);
      if (common >= 3) behind_facets.push_back(other);
    }
  rooms.push_back(behind_facets);
  with_topology(cell.kind, [&](auto topology) {
    for (const auto& [from, to] : decltype(topology)::edges) {
      std::vector<GapIndex> around{c};
      for (const GapIndex other : at_edges)
        if (other != c && gap.cell(other).has(cell.corners[from % 6]) && gap.cell(other).has(cell.corners[to % 6]))
          around.push_back(other);
      if (around.size() > 1) rooms.push_back(std::move(around));
    }
  });
  rooms.push_back(std::move(at_edges));
  return rooms;
}

GapCell cell_on(const GapMesh& gap, const Facet& facet, Vertex apex, std::int32_t region) {
  const auto& f = facet.corners;
  if (!facet.is_quad()) return gap.make_tet({f[0], f[2], f[1], apex}, region);
  return gap.make(CellKind::pyramid, {f[0], f[3], f[2], f[1], apex}, region);
}

Worth worth_of(const GapMesh& gap, std::span<const GapIndex> cells) {
  Worth worth{0, least_quality};
  for (const GapIndex c : cells) {
    worth.cost += cost_of(gap.cell(c).quality);
    worth.floor = std::min(worth.floor, gap.cell(c).quality);
  }
  worth.floor = std::max(worth.floor, surely_valid);
  return worth;
}

}  // namespace hexpipe::assemble::gap
