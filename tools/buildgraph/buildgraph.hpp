#pragma once
// The conflict graph of candidates, of all or of those that are needed: docs/definitions.md 2 and 5.

#include <cstdint>
#include <optional>
#include <string>

#include "formats/pipeline/stage_data.hpp"
#include "tools/buildgraph/options.hpp"

namespace hexpipe::buildgraph {

// Vertex i is candidate i: of the product's candidates where it has some, otherwise of those that were given.
struct BuildgraphResult {
  pipeline::GraphProduct product;
  std::optional<std::int64_t> dominated{};  // how many candidates BuildgraphOptions::reduce left out
};

// The names of the input in messages.
struct InputNames {
  std::string candidates = "candidates", mesh = "mesh";
};

// Builds the graph of the candidates that a stage read, whole or a part of a mesh. Throws UsageError when options do
// not go with the input, and DataError naming it when a part lacks keys, weights do not fit (see weights_of), or there
// are 2^31 candidates or more.
BuildgraphResult buildgraph(pipeline::StageData data, const BuildgraphOptions& options, const InputNames& names);

}  // namespace hexpipe::buildgraph
