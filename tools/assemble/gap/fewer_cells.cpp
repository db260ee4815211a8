#include "tools/assemble/gap/fewer_cells.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/passes.hpp"

namespace hexpipe::assemble::gap {
namespace {

constexpr std::int64_t most_refused = 20;

FewerCells merge(GapMesh& gap, const Surface& surface) {
  FewerCells counts;
  counts.merged = merge_vertices(gap);
  counts.on_surface = merge_on_surface(gap, surface.tags, surface.input);
  counts.merged += counts.on_surface;
  return counts;
}

// Rooms are small: their search gains most after the quick merges, and opens the way to more of these.
FewerCells merge_and_refill(GapMesh& gap, const Surface& surface, bool chosen_may_go) {
  FewerCells counts = merge(gap, surface);
  counts.merged += merge_stars(gap);
  const RefillCounts refilled = refill_rooms(gap);
  counts.merged += refilled.vertices + merge_stars(gap, true);
  counts.refilled = refilled.edges + refilled.poor;
  std::vector<std::uint32_t> ages = ages_of_vertices(gap);
  counts.closed = close_gaps(gap, surface.tags, surface.input);
  const ShortenCounts shortened = shorten_rows(gap, surface.tags, surface.input, chosen_may_go);
  counts.closed += shortened.vertices;
  counts.refilled += shortened.rooms;
  counts.rows_shortened = shortened.rows;
  counts.hexes_gone = shortened.hexes;
  if (counts.closed + shortened.rooms == 0) return counts;
  const RefillCounts again = refill_rooms_since(gap, std::move(ages));
  counts.merged += again.vertices;
  counts.refilled += again.edges + again.poor;
  return counts;
}

// Smoothing gives hexes the volume back that they lost before; now it is over.
template <class Mend>
FewerCells mend_and_grow(GapMesh& gap, Mend&& mend) {
  FewerCells counts;
  const double hex_volume = hex_volume_of(gap);
  MendCounts mended = mend(gap);
  counts.mended = mended.mended;
  counts.opened = std::move(mended.opened);
  counts.grown = grow_hexes(gap, hex_volume - hex_volume_of(gap));
  return counts;
}

// Whether so few cells are refused, and no hex, that all of them can be mended.
bool may_pass(const GapMesh& gap) {
  const std::int64_t refused = count_refused(gap);
  return refused > 0 && refused <= most_refused && !has_refused_hex(gap);
}

}  // namespace

FewerCells make_fewer_cells(hybrid::HybridMesh& mesh, const Surface& surface, std::span<const std::uint8_t> is_shared,
                            Passes passes) {
  FewerCells counts;
  GapMesh gap(mesh, surface.tags, is_shared);
  if (!gap.is_valid()) return counts;
  // The pieces of a mesh would have to agree on chosen cells that go.
  const bool chosen_may_go = is_shared.empty();
  switch (passes) {
    case Passes::merge:
      gap.ignore_faces();
      counts = merge(gap, surface);
      break;
    case Passes::merge_and_refill:
      counts = merge_and_refill(gap, surface, chosen_may_go);
      break;
    case Passes::mend:
      counts = mend_and_grow(gap, [&](GapMesh& poor) { return mend(poor, chosen_may_go); });
      break;
    case Passes::mend_refused:
      gap.be_strict();
      counts = mend_and_grow(gap, [](GapMesh& strict) { return mend_refused(strict); });
      break;
    case Passes::open_for_refused: {
      gap.be_strict();
      if (!may_pass(gap) || !chosen_may_go) return counts;
      const std::vector<Vec3> before = mesh.points;
      counts = mend_and_grow(gap, open_for_refused);
      // Worse cells, or one hex less, are worth it only if nothing is left that is refused.
      if (count_refused(gap) > 0) {
        std::ranges::copy(before, mesh.points.begin());
        return {};
      }
      break;
    }
  }
  if (counts.any()) gap.write_back();
  return counts;
}

}  // namespace hexpipe::assemble::gap
