#pragma once
// Reads a graph from a file in any of the known formats, as the options say.

#include <map>
#include <string>

#include "common/graph/conflict_graph.hpp"
#include "formats/choice/graph_options.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::formats {

// By the names that --graph-format has for them.
const std::map<std::string, GraphFormat>& graph_formats();

// Throws FormatError with the line, as the reader of the format does.
graph::ConflictGraph read_graph(Input& input, const GraphReading& reading = {}, LeftOut* left_out = nullptr);

}  // namespace hexpipe::formats
