#pragma once
// Cells around one that is wrong merge into a polyhedron that checkMesh accepts.

#include <compare>
#include <optional>
#include <span>
#include <vector>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

struct Merge {
  Cost cost;
  CellSet cells;
  auto operator<=>(const Merge&) const = default;
};

// The best set of cells with one of the seeds in it. Sets grow cell by cell, the best of each size (a beam search). The
// search ends at the first size at which a polyhedron has nothing wrong, and less is wrong around it than before. Cells
// of two regions never merge, nor do cells with a facet of a surface between them.
//   thorough     larger sets, and more of them
//   most_hexes   the volume of hexes that may become polyhedra; at 0 no set has hexes
//   near_misses  gets some sets of each size that leave one thing wrong, which moving a vertex may mend
std::optional<Merge> best_merge(MeasuredMesh& mesh, std::span<const std::int32_t> seeds, bool thorough,
                                double most_hexes, std::vector<Merge>& near_misses);

// Merges the cells into the first of them; the others have no faces afterwards. Faces towards one cell behind become
// one face, and so do facets of one surface that are as good as flat together. False if the polyhedron would not be a
// ball, or a face not a single loop; then the mesh is half changed, and the caller has to undo it.
bool merge_cells(MeasuredMesh& mesh, const CellSet& cells);

}  // namespace hexpipe::polyhedra
