#pragma once
// METIS .graph: a header line `n m [fmt [ncon]]`, then a line for each vertex with its weight and its neighbours,
// counted from 1, every edge at both ends. formats/README.md shows one.

#include <optional>
#include <string>

#include "common/graph/conflict_graph.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Takes fmt 0, 1, 10 and 11: without vertex weights every weight is 1, edge weights are read and left out, '%' begins a
// comment line, an empty line is a vertex without neighbours, neighbours may come in any order. Throws FormatError with
// the line for loops, repeated and one-sided edges, numbers out of range, and counts that disagree with the header.
graph::ConflictGraph read_metis(Input& input);

// Writes `n m 10`, neighbours ascending.
void write_metis(const graph::ConflictGraph& graph, Output& output);

// What other programs would do to these weights: METIS itself holds them in 31 bits, KaMIS sums them in 32, both
// without a word when they overflow. Says which --weight-scale would fit, as a factor of the present one. Empty when
// all is well.
std::optional<std::string> metis_weight_warning(const graph::ConflictGraph& graph);

}  // namespace hexpipe::formats
