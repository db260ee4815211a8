#include "tools/assemble/gap/fewer_cells.hpp"

#include <utility>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/passes.hpp"

namespace hexpipe::assemble::gap {
namespace {

FewerCells merge(GapMesh& gap, const Surface& surface) {
  FewerCells counts;
  counts.merged = merge_vertices(gap);
  counts.on_surface = merge_on_surface(gap, surface.tags, surface.input);
  counts.merged += counts.on_surface;
  return counts;
}

// Rooms are small: their search gains most after the quick merges, and opens the way to more of these.
FewerCells merge_and_refill(GapMesh& gap, const Surface& surface) {
  FewerCells counts = merge(gap, surface);
  counts.merged += merge_stars(gap);
  const RefillCounts refilled = refill_rooms(gap);
  counts.merged += refilled.vertices + merge_stars(gap, true);
  counts.refilled = refilled.edges + refilled.poor;
  return counts;
}

}  // namespace

FewerCells make_fewer_cells(hybrid::HybridMesh& mesh, const Surface& surface, std::span<const std::uint8_t> is_shared,
                            Passes passes) {
  FewerCells counts;
  GapMesh gap(mesh, surface.tags, is_shared);
  if (!gap.is_valid()) return counts;
  switch (passes) {
    case Passes::merge:
      gap.ignore_faces();
      counts = merge(gap, surface);
      break;
    case Passes::merge_and_refill:
      counts = merge_and_refill(gap, surface);
      break;
    case Passes::mend: {
      const double hex_volume = hex_volume_of(gap);
      // The pieces of a mesh would have to agree on chosen cells that go.
      MendCounts mended = mend(gap, is_shared.empty());
      counts.mended = mended.mended;
      counts.opened = std::move(mended.opened);
      // Smoothing gives hexes the volume back that they lost before; now it is over.
      counts.grown = grow_hexes(gap, hex_volume - hex_volume_of(gap));
      break;
    }
  }
  if (counts.any()) gap.write_back();
  return counts;
}

}  // namespace hexpipe::assemble::gap
