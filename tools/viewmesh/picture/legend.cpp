#include "tools/viewmesh/picture/legend.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/viewmesh/visible_cells.hpp"

namespace hexpipe::viewmesh::picture {
namespace {

// 12345 as 12,345.
std::string grouped(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

class Writer {
 public:
  Writer(const Scene& scene, const ViewState& state, Legend& legend) : scene_(scene), state_(state), legend_(legend) {}

  void write() {
    using Colour = ViewState::Colour;
    switch (state_.colour) {
      case Colour::hexes:
        legend_.subject = "scaled Jacobian of hexes";
        write_qualities();
        break;
      case Colour::quality:
        legend_.subject = "scaled Jacobian";
        write_qualities();
        break;
      case Colour::kind:
        legend_.subject = "kind of cell";
        write_kinds();
        break;
      case Colour::region:
        legend_.subject = "region";
        write_groups(scene_.regions, ViewState::HiddenGroup::Kind::region);
        break;
      case Colour::surface:
        legend_.subject = "surface";
        write_groups(scene_.surfaces, ViewState::HiddenGroup::Kind::surface);
        break;
      default:
        write_measure(*measure_of(state_.colour));
    }
    if (state_.dislocations && !scene_.dislocations.empty()) add("dislocations", colours_["dislocations"]);
  }

 private:
  void add(const std::string& text, const nlohmann::json& colour) {
    legend_.keys.push_back({parse_colour(colour), text});
  }

  void write_qualities() {
    legend_.ticks = {"0", "0.25", "0.5", "0.75", "1"};
    const bool only_hexes = state_.colour == ViewState::Colour::hexes;
    if (only_hexes && scene_.kind_begin[1] < scene_.cell_count()) add("other cells", colours_["plain"]);
    if (std::ranges::any_of(scene_.quality, [](float quality) { return !(quality > 0); }))
      add("not positive", colours_["invalid"]);
  }

  void write_kinds() {
    for (std::size_t k = 0; k < scene_kinds.size(); ++k)
      if (scene_.kind_begin[k] < scene_.kind_begin[k + 1] && state_.kinds[k])
        add(name_of(scene_kinds[k]), colours_["kinds"][name_of(scene_kinds[k])]);
  }

  void write_groups(const std::vector<Group>& groups, ViewState::HiddenGroup::Kind kind) {
    const auto hidden = hidden_places(state_, kind, groups);
    const auto& palette = colours_["groups"];
    for (std::size_t place = 0; place < groups.size(); ++place)
      if (!hidden[place]) add(groups[place].name, palette[place % palette.size()]);
  }

  void write_measure(std::size_t measure) {
    const auto& range = colours_["measures"][measure_names[measure]];
    const double best = range["best"], limit = range["limit"], unit = range["unit"];
    legend_.subject = range["title"];
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0})
      legend_.ticks.push_back(fmt::format("{:.3g}", (limit + part * (best - limit)) / unit));
    const auto missing = std::ranges::count_if(
        scene_.measures[measure], [&](std::int32_t value) { return best > limit ? value < limit : value > limit; });
    if (missing > 0)
      add(fmt::format("{} {} it", grouped(static_cast<std::size_t>(missing)),
                      missing == 1 ? "cell misses" : "cells miss"),
          colours_["invalid"]);
  }

  const Scene& scene_;
  const ViewState& state_;
  Legend& legend_;
  const nlohmann::json& colours_ = page_colours();
};

}  // namespace

Legend legend_of(const Scene& scene, const ViewState& state, const std::string& title) {
  Legend legend;
  legend.title = title;
  if (const auto share = scene.hex_share()) legend.share = fmt::format("{:.1f} %", 100 * *share);
  Writer(scene, state, legend).write();
  return legend;
}

}  // namespace hexpipe::viewmesh::picture
