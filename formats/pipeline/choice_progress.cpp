#include "formats/pipeline/choice_progress.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/mwis/ground/target_weight.hpp"
#include "formats/pipeline/quads_of_choice.hpp"

namespace hexpipe::pipeline {
namespace {

// The line must cost no measurable time: a hundredth of the search at most.
constexpr double rest_after_work = 100;

// tetmesh tells it; 0 for meshes of other programs.
double volume_in(const std::vector<nlohmann::ordered_json>& history) {
  for (const auto& entry : history)
    if (const auto volume = entry.find("volume"); volume != entry.end() && volume->is_number())
      return volume->get<double>();
  return 0;
}

}  // namespace

ChoiceProgress::ChoiceProgress(Step& step, const StageData& data, bool graph_of_bundle)
    : step_(step), volumes_(data.volumes), mesh_volume_(volume_in(data.history)) {
  if (graph_of_bundle) bound_ = mwis::ground::bound_in(data.history);
  if (data.quads) of_quads_ = weight_of_quads(data);
}

void ChoiceProgress::show(std::int64_t weight, const std::function<graph::IndependentSet()>& solution) {
  if (!step_.due() || watch_.seconds() < next_) return;
  const double began = watch_.seconds();
  step_.say(text_of(weight, solution()));
  const double ended = watch_.seconds();
  next_ = ended + rest_after_work * (ended - began);
}

std::string ChoiceProgress::text_of(std::int64_t weight, const graph::IndependentSet& chosen) const {
  std::int64_t hexes = 0;
  double volume = 0;
  for (const std::int32_t c : chosen) {
    const auto i = static_cast<std::size_t>(c);
    if (i >= std::min(volumes_.kind.size(), volumes_.volume.size()) || volumes_.kind[i] != CellKind::hex) continue;
    ++hexes;
    volume += volumes_.volume[i];
  }
  std::string text = hexes > 0 ? fmt::format("{} hexes", hexes) : fmt::format("{} chosen", chosen.size());
  if (hexes > 0 && mesh_volume_ > 0) text += fmt::format(", {:.1f} % of the volume", 100 * volume / mesh_volume_);
  if (bound_)
    text += fmt::format(", gap {:.3f} %", 100 * mwis::ground::gap_to(*bound_ - of_quads_, weight - of_quads_));
  return text;
}

}  // namespace hexpipe::pipeline
