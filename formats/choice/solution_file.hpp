#pragma once
// .sol, an independent set in either of the two forms that solvers write: the numbers of the chosen vertices, counted
// from 1, one a line (CHILS); or a line 0 or 1 for each vertex (KaMIS). formats/README.md shows both.

#include <cstdint>

#include "common/graph/conflict_graph.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Told apart by the graph's size: a file with a line for each vertex, each of them 0 or 1, is of the second form. One
// file is both, a single line 1 for a graph of one vertex, and means the same either way. Numbers may come in any
// order. The result is ascending. Throws FormatError with the line for numbers out of range or repeated; whether two
// chosen vertices are neighbours is for validate(IndependentSet, ConflictGraph) to say: assemble has no graph.
graph::IndependentSet read_solution(Input& input, std::int64_t vertex_count);

// Writes the first form, ascending.
void write_solution(const graph::IndependentSet& solution, Output& output);

}  // namespace hexpipe::formats
