#pragma once
// DIMACS graphs as colouring, clique and vertex cover programs exchange them: `p edge N M`, then `n V WEIGHT` and `e U
// V` lines. formats/README.md shows one.

#include "common/graph/conflict_graph.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::formats {

// True when the text begins with a DIMACS comment or problem line. Takes nothing.
bool looks_like_dimacs(Input& input);

// `p` names the problem in any word (edge, col, td, vc, ...), weights come as `n V W` or `v V W` and are 1 elsewhere,
// edges as `e U V` or `U V`. An edge may come twice, as in many colouring files. Throws FormatError with the line for
// loops, numbers out of range, weights given twice, unknown lines, and fewer or more edges than the problem line says.
graph::ConflictGraph read_dimacs(Input& input);

}  // namespace hexpipe::formats
