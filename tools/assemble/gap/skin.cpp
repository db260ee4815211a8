#include "tools/assemble/gap/skin.hpp"

#include <algorithm>

#include "common/mesh/item_lists.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// Worse cells may be replaced, but may not take the place of others: below this, the sign may be rounding.
constexpr double surely_valid = 1e-6;

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

Joining join_skin(const GapMesh& gap, const GapCell& cell, std::vector<Facet>& skin) {
  Joining joining;
  for_facets(cell.kind, cell.vertices(), [&](const Facet& facet) {
    const auto twin = std::ranges::find(skin, facet.reversed());
    if (twin == skin.end()) {
      skin.push_back(facet);
      return;
    }
    skin.erase(twin);
    joining.touches = true;
    joining.crosses_tagged =
        joining.crosses_tagged ||
        (!facet.is_quad() && gap.is_tagged({facet.corners[0], facet.corners[1], facet.corners[2]}));
  });
  return joining;
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
