#pragma once
// .sol, an independent set in one of the two forms that solvers write: the numbers of the chosen vertices, counted from
// 1, each on a line (CHILS); or a line 0 or 1 for each vertex (KaMIS). formats/README.md shows both.

#include <cstdint>

#include "common/graph/conflict_graph.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// The graph's size tells the forms apart: a file with a line 0 or 1 for each vertex has the second form. Only a single
// line 1 for a graph of one vertex has both, and means the same in both. Numbers may come in any order; the result is
// ascending. Throws FormatError with the line for numbers out of range or repeated. It does not look for chosen
// neighbours, as assemble has no graph: validate(IndependentSet, ConflictGraph) does.
graph::IndependentSet read_solution(Input& input, std::int64_t vertex_count);

// Writes the first form, ascending.
void write_solution(const graph::IndependentSet& solution, Output& output);

}  // namespace hexpipe::formats
