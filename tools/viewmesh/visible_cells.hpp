#pragma once
// Which cells and surfaces of a scene a view shows.

#include <vector>

#include "tools/viewmesh/scene.hpp"
#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh {

// For each place of `groups`, whether the state hides that group.
std::vector<bool> hidden_places(const ViewState& state, ViewState::HiddenGroup::Kind kind,
                                const std::vector<Group>& groups);

// A clip's plane: what lies beyond has dot(normal, place) > beyond.
double clip_plane(const Scene& scene, const ViewState::Clip& clip);

// For each cell whether the state shows it.
std::vector<bool> visible_cells(const Scene& scene, const ViewState& state);

}  // namespace hexpipe::viewmesh
