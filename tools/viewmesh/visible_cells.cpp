#include "tools/viewmesh/visible_cells.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe::viewmesh {

std::vector<bool> hidden_places(const ViewState& state, ViewState::HiddenGroup::Kind kind,
                                const std::vector<Group>& groups) {
  std::vector<bool> places(groups.size());
  for (const auto& hidden : state.hidden)
    if (hidden.kind == kind && hidden.tag)
      if (const std::size_t place = place_of(groups, *hidden.tag); place < groups.size()) places[place] = true;
  return places;
}

double clip_plane(const Scene& scene, const ViewState::Clip& clip) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& block : scene.corners)
    for (const auto vertex : block) {
      const double along = dot(clip.normal, scene.point(vertex));
      low = std::min(low, along), high = std::max(high, along);
    }
  return low + clip.fraction * (high - low);
}

std::vector<bool> visible_cells(const Scene& scene, const ViewState& state) {
  const double beyond = state.clip ? clip_plane(scene, *state.clip) : 0;
  const auto hidden = hidden_places(state, ViewState::HiddenGroup::Kind::region, scene.regions);
  const bool any_hidden = std::find(hidden.begin(), hidden.end(), true) != hidden.end();
  std::vector<bool> visible(scene.cell_count());
  for (std::int32_t cell = 0; cell < scene.cell_count(); ++cell)
    visible[cell] = state.kinds[scene.kind_index(cell)] && scene.layer[cell] > state.peel &&
                    scene.quality[cell] >= static_cast<float>(state.least_quality) &&
                    scene.quality[cell] <= static_cast<float>(state.greatest_quality) &&
                    !(any_hidden && hidden[place_of(scene.regions, scene.region[cell])]) &&
                    (!state.clip || dot(state.clip->normal, scene.middle_of(cell)) <= beyond);
  if (state.fragment > 0 && static_cast<std::size_t>(state.fragment) <= scene.fragments.size()) {
    const auto& fragment = scene.fragments[state.fragment - 1];
    for (std::int32_t cell = 0; cell < scene.cell_count(); ++cell)
      if (!std::binary_search(fragment.begin(), fragment.end(), cell)) visible[cell] = false;
  }
  return visible;
}

}  // namespace hexpipe::viewmesh
