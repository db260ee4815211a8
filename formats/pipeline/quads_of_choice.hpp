#pragma once
// A choice from a graph with vertices of quads (common/conflicts/quad_vertices.hpp), which stand behind those of the
// candidates.

#include <cstdint>
#include <optional>

#include "common/run/run_context.hpp"
#include "formats/pipeline/stage_data.hpp"

namespace hexpipe::pipeline {

// The number of quads in a graph, 0 for a plain one.
std::int32_t quad_count(const StageData& data);

// The weight of all vertices of quads. The weight of a solution that has every quad without a chosen candidate, less
// this, is that of its candidates, less the prices of open quads. The graph may be read without its edges.
std::int64_t weight_of_quads(const StageData& data);

// Tells --stats and -v how many candidates a solution has, and its value: weights less the prices of open quads. Says
// nothing if the graph has no quads. `bound`: no solution weighs more, where that is known.
void report_candidates(RunContext& context, const graph::IndependentSet& solution, const StageData& data,
                       std::optional<std::int64_t> bound = std::nullopt);

// Leaves the candidates in the solution, if there is one, and the vertices of quads out.
void drop_quads(StageData& data);

}  // namespace hexpipe::pipeline
