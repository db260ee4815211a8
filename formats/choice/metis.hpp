#pragma once
// METIS .graph: a header line `n m [fmt [ncon]]`, then a line for each vertex with its weight and its neighbours,
// counted from 1, every edge at both ends. formats/README.md shows one.

#include <optional>
#include <string>

#include "common/graph/conflict_graph.hpp"
#include "formats/choice/graph_options.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Reads fmt 0, 1, 10 and 11. Without vertex weights every weight is 1; edge weights are dropped. '%' begins a comment
// line, an empty line is a vertex without neighbours, and neighbours may come in any order. Throws FormatError with the
// line for loops, repeated and one-sided edges, numbers out of range, and counts that disagree with the header. A
// tolerant reading leaves out loops and repeated edges, which the header may count or not.
graph::ConflictGraph read_metis(Input& input, const GraphReading& reading, LeftOut& left_out);

// Writes `n m 10`, neighbours ascending.
void write_metis(const graph::ConflictGraph& graph, Output& output);

// A warning if other programs cannot hold these weights: METIS holds them in 31 bits, KaMIS sums them in 32, and
// neither reports an overflow. It names the --weight-scale that would fit, as a factor of the current one.
std::optional<std::string> metis_weight_warning(const graph::ConflictGraph& graph);

}  // namespace hexpipe::formats
