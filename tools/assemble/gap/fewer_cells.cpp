#include "tools/assemble/gap/fewer_cells.hpp"

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/merge_on_surface.hpp"
#include "tools/assemble/gap/merge_stars.hpp"
#include "tools/assemble/gap/merge_vertices.hpp"
#include "tools/assemble/gap/refill_rooms.hpp"

namespace hexpipe::assemble::gap {

FewerCells make_fewer_cells(hybrid::HybridMesh& mesh, const Surface& surface, std::span<const std::uint8_t> is_shared,
                            bool quickly) {
  FewerCells counts;
  GapMesh gap(mesh, surface.tags, is_shared);
  if (!gap.is_valid()) return counts;
  if (quickly) gap.ignore_faces();
  counts.merged = merge_vertices(gap);
  counts.on_surface = merge_on_surface(gap, surface.tags, surface.input);
  counts.merged += counts.on_surface;
  if (!quickly) {
    // Rooms are small: their search gains most after the quick merges, and opens the way to more of these.
    counts.merged += merge_stars(gap);
    const RefillCounts refilled = refill_rooms(gap);
    counts.merged += refilled.vertices + merge_stars(gap, true);
    counts.refilled = refilled.edges + refilled.poor;
  }
  if (counts.any()) gap.write_back();
  return counts;
}

}  // namespace hexpipe::assemble::gap
