#pragma once
// Reads a graph from a file in any of the known formats, as the options say.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/graph/conflict_graph.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::formats {

enum class GraphFormat { metis, dimacs, matrix_market, edges };
const std::map<std::string, GraphFormat>& graph_formats();

struct GraphReading {
  std::optional<GraphFormat> format{};   // by the first bytes, where it is not given
  std::optional<double> weight_scale{};  // weights may be any numbers, and are rounded after multiplication by this
  bool tolerant = false;                 // repeated edges count once, loops are left out
  bool complement = false;               // the edges are those that the file does not have
};

// The counts of what was left out, for a message.
struct LeftOut {
  std::int64_t loops = 0, repeated = 0;
};

// Throws FormatError with the line, as the reader of the format does.
graph::ConflictGraph read_graph(Input& input, const GraphReading& reading = {}, LeftOut* left_out = nullptr);

}  // namespace hexpipe::formats
