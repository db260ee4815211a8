#pragma once
// The passes over the cells between the hexes. Each makes changes while the objective falls (objective.hpp). The cells
// of `gap` have to be valid, and stay so.

#include <cstdint>
#include <vector>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::gap {

// Merges vertices that no hex uses into neighbours. The pair that lowers the objective most goes first. No cell falls
// below least_quality where none was below before. Returns the number of vertices that are gone.
std::int64_t merge_vertices(GapMesh& gap);

// Merges vertices on the surface that no chosen cell uses into neighbours along it: a vertex within a smooth part of
// the surface into any neighbour on it, one on a curve into the next on the curve. The surface stays as near to the
// input's as most_deviation_at() says. Corners stay, and vertices where more than one sheet ends. `tags`, those of
// `gap`, follow. Returns the number of vertices that are gone.
std::int64_t merge_on_surface(GapMesh& gap, hybrid::SurfaceTags& tags, const shape::InputSurface& surface);

// Merges two vertices that no hex uses at the place where the worst cell around it is best, so that pyramids share
// their apexes. The two have a cell in common, or cells on both sides of a facet. The pair that lowers the objective
// most goes first. With `neighbours_yield`, inner vertices around the two move, too, also those of chosen cells
// (patch.hpp). Returns the number of vertices that are gone.
std::int64_t merge_stars(GapMesh& gap, bool neighbours_yield = false);

// Merges two vertices of different chosen cells where an edge of the gap joins them, so that the gap closes there: the
// room around is filled anew, and inner vertices move (close_gaps.hpp). On the surface as for merge_on_surface(), or
// in the middle of the two where that leaves the surface as it is. Returns the number of vertices that are gone.
std::int64_t close_gaps(GapMesh& gap, hybrid::SurfaceTags& tags, const shape::InputSurface& surface);

struct ShortenCounts {
  std::int64_t rows = 0;      // that are one hex shorter, over the whole column of prisms at which they end
  std::int64_t pairs = 0;     // vertices of chosen cells that became one across the gap
  std::int64_t rooms = 0;     // filled anew
  std::int64_t vertices = 0;  // gone
  std::int64_t hexes = 0;     // gone, less those that came
};

// Shortens rows of hexes that end inside where that leaves fewer cells between the hexes, fills rooms of any size anew,
// and closes gaps across such rooms (reshape.hpp). Chosen cells may go, become prisms or come. Without `chosen_may_go`
// rooms alone are filled.
ShortenCounts shorten_rows(GapMesh& gap, hybrid::SurfaceTags& tags, const shape::InputSurface& surface,
                           bool chosen_may_go = true);

struct RefillCounts {
  std::int64_t vertices = 0;  // gone, because the room of the cells around them was filled anew
  std::int64_t edges = 0;     // whose cells' room was filled anew
  std::int64_t poor = 0;      // cells below least_quality that became better with those around them
};

// Fills small rooms anew (refill.hpp): the cells around a free vertex, those around an edge, and those around a poor
// cell.
RefillCounts refill_rooms(GapMesh& gap);
// The same only where vertices are older than they were, by vertex, and in a few rings of cells around.
RefillCounts refill_rooms_since(GapMesh& gap, std::vector<std::uint32_t> ages);
std::vector<std::uint32_t> ages_of_vertices(const GapMesh& gap);

struct Opened {
  std::int64_t inserted = 0;      // rooms of gap cells that were filled anew
  std::vector<CellIndex> chosen;  // cells that are gone
};

// Puts new vertices into the rooms around cells of the gap that are worse than least_wanted. Where that does not help,
// a chosen cell beside the poor one goes, or two: better pyramids and tets take its room, and the poor cell improves.
// No other cell falls below least_wanted that was not below before. At most nine chosen cells and one more in each 300
// go.
Opened open_hexes(GapMesh& gap);
// Puts a new vertex into a wide room (wide_rooms.hpp) around each cell that is still worse than least_wanted, the worst
// first. Up to three chosen cells may go for it, one of them a hex. The cells that come are more than those that go:
// that is worth it only if no cell below least_wanted is left. Otherwise everything is as before.
Opened open_wide(GapMesh& gap);

// Moves inner vertices out of the hexes that they belong to, into the cells of the gap, until the hexes are larger by
// `volume`, as far as that costs little (objective.hpp). No cell of the gap falls below 0.2 that was not below before.
// Returns the number of moves.
std::int64_t grow_hexes(GapMesh& gap, double volume);

struct MendCounts {
  std::int64_t mended = 0;        // changes
  std::vector<CellIndex> opened;  // chosen cells that are gone
};

// The last pass, when vertices have found their places. It looks at cells below least_quality, and at cells with a face
// that costs something. It fills the room around them anew, moves their inner vertices, or, for a cell below
// least_quality, raises the worst cells at its vertices together; then open_hexes() if `may_open`, and all of that
// again while it changes something.
MendCounts mend(GapMesh& gap, bool may_open);

// What checkMesh counts as wrong: cells of low determinant, faces of low weight, and quads neither of whose diagonals
// suits both cells (common/mesh/face_measures.hpp). `gap` has to be strict. The number of cells of the gap, and of
// chosen prisms and pyramids, that are so or have such a face.
std::int64_t count_refused(const GapMesh& gap);
// Whether a chosen hex is so, as most are in a single layer; chosen cells have to be as in the mesh that `gap` was made
// of.
bool has_refused_hex(const GapMesh& gap);

// Mends what is counted: vertices move, rooms are filled anew, or a new vertex comes, one for 300 chosen cells at most.
// Hexes lose 0.02 % of their volume at most. No cell of the gap falls below least_quality that was not below before.
MendCounts mend_refused(GapMesh& gap);
// The same down to least_wanted. Chosen cells may go, too: prisms and pyramids that are counted, and hexes, one of
// 1,000.
MendCounts open_for_refused(GapMesh& gap);

}  // namespace hexpipe::assemble::gap
