#pragma once
// MatrixMarket files of sparse square matrices, whose entries off the diagonal are edges. formats/README.md shows one.

#include "common/graph/conflict_graph.hpp"
#include "formats/choice/graph_options.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::formats {

// True when the text begins with %%MatrixMarket, in any case. Takes nothing.
bool looks_like_matrix_market(Input& input);

// Takes `matrix coordinate`, pattern, integer, real or complex, of any symmetry; values are left out, every vertex has
// the weight 1. An entry may come on both sides of the diagonal, and is one edge; what is on the diagonal is left out.
// Throws FormatError with the line for arrays (dense matrices), matrices that are not square, numbers out of range, and
// fewer or more entries than the header says.
graph::ConflictGraph read_matrix_market(Input& input, LeftOut& left_out);

}  // namespace hexpipe::formats
