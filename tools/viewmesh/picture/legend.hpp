#pragma once
// The lines of a picture's legend; page/legend.js has the same.

#include <optional>
#include <string>
#include <vector>

#include "tools/viewmesh/scene.hpp"
#include "tools/viewmesh/skin.hpp"
#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh::picture {

struct Legend {
  struct Key {
    Rgb colour;
    std::string text;
  };

  std::string title;
  std::optional<std::string> share;  // of the volume in hexes
  std::string subject;               // by what cells are coloured
  std::vector<std::string> ticks;    // of the scale of colours; none: there is no scale
  std::vector<Key> keys;
};

Legend legend_of(const Scene& scene, const ViewState& state, const std::string& title);

}  // namespace hexpipe::viewmesh::picture
