#pragma once
// Cells around one that is wrong merge to a polyhedron in which nothing is wrong.

#include <compare>
#include <optional>
#include <span>
#include <vector>

#include "formats/polyhedra/local_changes.hpp"

namespace hexpipe::polyhedra {

struct Merge {
  Worth worth;
  CellSet cells;
  auto operator<=>(const Merge&) const = default;
};

// The best set of cells with one of the seeds in it: of the smallest sets that leave nothing wrong with the polyhedron,
// and less around it than before. Cells of two regions never merge, nor do cells with a facet of a surface between
// them. `thorough`: larger sets, and more of them. `most_hexes`: the volume of hexes that may become polyhedra; they
// are in the set only if it is above 0. `nearly` gets some sets of each size that leave only one thing wrong, which a
// moved vertex may mend.
std::optional<Merge> best_merge(MeasuredMesh& mesh, std::span<const std::int32_t> seeds, bool thorough,
                                double most_hexes, std::vector<Merge>& nearly);

// The first cell of the set becomes the polyhedron, the others are gone. Faces to one cell behind become one, and so do
// facets of one surface that are as good as flat together. False if the polyhedron is no ball with a simple skin; then
// the mesh is half changed.
bool merge_cells(MeasuredMesh& mesh, const CellSet& cells);

}  // namespace hexpipe::polyhedra
