#include "formats/pipeline/quads_of_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "common/mwis/ground/target_weight.hpp"

namespace hexpipe::pipeline {
namespace {

// The vertex of the first quad, behind the candidates.
std::int32_t first_quad(const StageData& data) {
  if (data.graph) return data.graph->vertex_count() - quad_count(data);
  return static_cast<std::int32_t>(data.candidates->size());
}

std::int64_t candidates_in(const graph::IndependentSet& solution, const StageData& data) {
  return std::ranges::lower_bound(solution, first_quad(data)) - solution.begin();
}

}  // namespace

std::int32_t quad_count(const StageData& data) {
  return data.quads ? static_cast<std::int32_t>(data.quads->size()) : 0;
}

std::int64_t weight_of_quads(const StageData& data) {
  const auto& weights = data.graph->weights;
  return std::accumulate(weights.begin() + first_quad(data), weights.end(), std::int64_t{0});
}

void report_candidates(RunContext& context, const graph::IndependentSet& solution, const StageData& data,
                       std::optional<std::int64_t> bound) {
  if (!data.quads) return;
  const std::int64_t of_quads = weight_of_quads(data), count = candidates_in(solution, data);
  const std::int64_t value = graph::total_weight(solution, *data.graph) - of_quads;
  context.statistics["candidates"] = count;
  context.statistics["value"] = value;
  std::string line =
      fmt::format("{} of the chosen are candidates, worth {} with the prices of open quads paid", count, value);
  if (bound) {
    const std::int64_t most = *bound - of_quads;
    const double gap = mwis::ground::gap_to(most, value);
    context.statistics["value_bound"] = most;
    context.statistics["value_gap"] = gap;
    line += fmt::format("; at most {} is possible: gap {:.4f} %", most, 100 * gap);
  }
  context.note(line);
}

void drop_quads(StageData& data) {
  if (!data.quads || !data.solution || !(data.graph || data.candidates)) return;
  data.solution->resize(static_cast<std::size_t>(candidates_in(*data.solution, data)));
}

}  // namespace hexpipe::pipeline
