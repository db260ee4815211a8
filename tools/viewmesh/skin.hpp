#pragma once
// The triangles that are drawn: facets with a visible cell on one side only.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/viewmesh/scene.hpp"
#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh {

// The layout that page/skin.vert expects.
struct SkinVertex {
  std::array<float, 3> position;
  std::array<std::int8_t, 4> normal;   // of the facet, 127 is 1; the fourth is not used
  std::array<std::uint8_t, 4> colour;  // and the code of the corner
};

using Rgb = std::array<std::uint8_t, 3>;

// Three vertices per triangle.
std::vector<SkinVertex> visible_skin(const Scene& scene, const ViewState& state);

// The colour at a share of the way from the first to the last.
Rgb mixed(const std::vector<Rgb>& colours, double along);

// The colours of the page, from page/colours.json.
Rgb parse_colour(const std::string& text);
const nlohmann::json& page_colours();

}  // namespace hexpipe::viewmesh
