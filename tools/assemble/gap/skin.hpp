#pragma once
// Rooms: the space that a few cells fill together, and the facets around it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap/gap_mesh.hpp"

namespace hexpipe::assemble::gap {

// Counter-clockwise as seen from outside of its cell, the least vertex first; a triangle ends in no_index.
struct Facet {
  std::array<Vertex, 4> corners;

  static Facet of(std::span<const Vertex> corners);
  bool is_quad() const { return corners[3] != no_index; }
  std::span<const Vertex> vertices() const { return std::span(corners).first(is_quad() ? 4 : 3); }
  Facet reversed() const;
  bool has(Vertex v) const { return std::ranges::find(vertices(), v) != vertices().end(); }
  // Most facets differ in their first corner: a call of memcmp for each took a third of the time.
  bool operator==(const Facet& other) const {
    return corners[0] == other.corners[0] && corners[1] == other.corners[1] && corners[2] == other.corners[2] &&
           corners[3] == other.corners[3];
  }
};

// Calls visit(facet) for each facet of a cell.
template <class Visit>
void for_facets(CellKind kind, std::span<const Vertex> corners, Visit&& visit) {
  auto each = [&](const auto& facets) {
    for (const auto& facet : facets) {
      std::array<Vertex, 4> own{};
      for (std::size_t i = 0; i < facet.size(); ++i) own[i] = corners[facet[i]];
      visit(Facet::of(std::span(own).first(facet.size())));
    }
  };
  with_topology(kind, [&](auto topology) {
    each(decltype(topology)::triangles);
    each(decltype(topology)::quads);
  });
}

struct Room {
  std::vector<Facet> skin;       // of the cells in the room; what lies between two of them is not part of it
  std::vector<Vertex> vertices;  // of the skin, ascending
  std::int32_t region = 0;
};

// Adds a facet to a skin. If the other side of it is there, both are gone: true then.
bool add_facet(const Facet& facet, std::vector<Facet>& skin);

// How a cell joins others: whether they have a facet in common, and whether such a facet is tagged.
struct Joining {
  bool touches = false, crosses_tagged = false;
};
// Extends `skin`, that of some cells, by one more cell, or by the skin of others.
Joining join_skin(const GapMesh& gap, const GapCell& cell, std::vector<Facet>& skin);
Joining join_skin(const GapMesh& gap, std::span<const Facet> other, std::vector<Facet>& skin);

bool is_tagged(const GapMesh& gap, const Facet& facet);

// The mean of the corners of all facets.
Vec3 middle_of(std::span<const Vec3> points, std::span<const Facet> skin);

// The room of these cells. Nothing if they are of several regions, if a tagged facet or a vertex that has to stay lies
// between them, or if more than `most_facets` are around them.
std::optional<Room> room_of(const GapMesh& gap, std::span<const GapIndex> cells, std::size_t most_facets);

// The facets of a chosen cell, on the boundary as the tagged triangles. Nothing if a quad has nothing behind it.
std::optional<std::vector<Facet>> skin_of(const GapMesh& gap, KeptIndex kept);

// Whether each edge is one of two facets: only then do two of the cells around a vertex in the room meet at it.
bool is_ball(std::span<const Facet> skin);

// Rooms of gap cells around c: with the cells behind its facets; with those around each of its edges; with all that
// share an edge with it.
std::vector<std::vector<GapIndex>> rooms_around(const GapMesh& gap, GapIndex c);

// The cell on the inner side of a facet of the skin, with its last corner at `apex`: a tet or a pyramid.
GapCell cell_on(const GapMesh& gap, const Facet& facet, Vertex apex, std::int32_t region);

// The cost of some cells together, and the least quality of cells that may take their place.
struct Worth {
  double cost = 0, floor = 0;
};
Worth worth_of(const GapMesh& gap, std::span<const GapIndex> cells);

}  // namespace hexpipe::assemble::gap
