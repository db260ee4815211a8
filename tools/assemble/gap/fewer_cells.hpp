#pragma once
// Makes the cells between the hexes fewer and better.

#include <cstdint>
#include <span>
#include <vector>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::gap {

struct FewerCells {
  std::int64_t merged = 0;          // vertices that no hex uses, into others
  std::int64_t on_surface = 0;      // of these, along the surface
  std::int64_t closed = 0;          // vertices of chosen cells, across the gap between them
  std::int64_t refilled = 0;        // rooms
  std::int64_t rows_shortened = 0;  // by one hex, over the whole column of prisms at which they end
  std::int64_t hexes_gone = 0;      // for rows, rooms and gaps, less those that came
  std::int64_t mended = 0;          // cells, in the last pass
  std::int64_t grown = 0;           // moves out of hexes, in the last pass
  std::vector<CellIndex> opened;    // chosen cells that are gone

  bool any() const { return merged + closed + refilled + mended + grown > 0 || !opened.empty(); }
  FewerCells& operator+=(const FewerCells& more) {
    merged += more.merged, on_surface += more.on_surface, closed += more.closed;
    refilled += more.refilled, rows_shortened += more.rows_shortened, hexes_gone += more.hexes_gone;
    mended += more.mended, grown += more.grown;
    opened.insert(opened.end(), more.opened.begin(), more.opened.end());
    return *this;
  }
};

// The surface along which vertices may merge: as it is now, and as the input had it.
struct Surface {
  hybrid::SurfaceTags& tags;
  const shape::InputSurface& input;
};

enum class Passes {
  merge,             // vertices into neighbours, whatever faces cost: for a mesh that has not been smoothed yet
  merge_and_refill,  // all merges, and small rooms filled anew
  mend,              // only what is poor becomes better: for a mesh that is not smoothed any more
  mend_refused,      // the same for what checkMesh counts as wrong
  open_for_refused   // the same where chosen cells have to go for it: only if nothing is wrong afterwards
};

// Lowers the objective (objective.hpp). The mesh has to conform; nothing is done if a tet, or a cell made of tets, is
// not valid. Chosen cells stay, except those `opened` and those that rows, rooms and gaps take (shorten_rows()); shared
// vertices stay where they are, and vertices on tagged facets stay on them.
FewerCells make_fewer_cells(hybrid::HybridMesh& mesh, const Surface& surface, std::span<const std::uint8_t> is_shared,
                            Passes passes);

}  // namespace hexpipe::assemble::gap
