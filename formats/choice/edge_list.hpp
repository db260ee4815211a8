#pragma once
// Edge lists, as SNAP and KONECT have them: a line `u v` for each edge. formats/README.md shows one.

#include "common/graph/conflict_graph.hpp"
#include "formats/choice/graph_options.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::formats {

// True when the text begins with a comment of '#', as SNAP's do. Takes nothing.
bool looks_like_edge_list(Input& input);

// Vertices are numbered from 0 if there is a 0, otherwise from 1, up to the highest number in the file; each has weight
// 1. More numbers on a line are left out; '#' and '%' begin comments. An edge may come several times and in both
// directions; loops are left out.
graph::ConflictGraph read_edge_list(Input& input, LeftOut& left_out);

}  // namespace hexpipe::formats
