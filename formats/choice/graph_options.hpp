#pragma once
// What the options say about a graph file, and what its reader reports.

#include <cstdint>
#include <optional>

namespace hexpipe::formats {

enum class GraphFormat { metis, dimacs, matrix_market, edges };

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

}  // namespace hexpipe::formats
