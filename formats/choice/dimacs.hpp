#pragma once
// Reads DIMACS graphs, as programs for colouring, clique and vertex cover exchange them: `p edge N M`, then `n V
// WEIGHT` and `e U V` lines. formats/README.md shows one.

#include "common/graph/conflict_graph.hpp"
#include "formats/choice/graph_options.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::formats {

// True when the text begins with a DIMACS comment or problem line. Takes nothing from the input.
bool looks_like_dimacs(Input& input);

// The problem may have any name (edge, col, td, vc, ...). Weights stand as `n V W` or `v V W`, and are 1 otherwise;
// edges stand as `e U V` or `U V`. An edge may come twice, as in many colouring files. Throws FormatError with the line
// for loops, numbers out of range, weights given twice, unknown lines, and fewer or more edges than the problem line
// says. A tolerant reading leaves out loops.
graph::ConflictGraph read_dimacs(Input& input, const GraphReading& reading, LeftOut& left_out);

}  // namespace hexpipe::formats
