#include "formats/pipeline/quads_of_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

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

std::optional<ChosenCandidates> without_quads(const graph::IndependentSet& solution, const StageData& data) {
  if (!data.quads) return std::nullopt;
  return ChosenCandidates{candidates_in(solution, data),
                          graph::total_weight(solution, *data.graph) - weight_of_quads(data)};
}

std::string summary(const ChosenCandidates& chosen) {
  return fmt::format("{} of the chosen are candidates, worth {} with the prices of open quads paid", chosen.count,
                     chosen.value);
}

void drop_quads(StageData& data) {
  if (!data.quads || !data.solution || !(data.graph || data.candidates)) return;
  data.solution->resize(static_cast<std::size_t>(candidates_in(*data.solution, data)));
}

}  // namespace hexpipe::pipeline
