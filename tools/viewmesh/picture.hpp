#pragma once
// Draws the picture that the page shows without a browser: Mesa runs the same shaders in memory.

#include <cstdint>
#include <vector>

#include "formats/streams/output.hpp"
#include "tools/viewmesh/scene.hpp"
#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top
};

// Throws DataError when Mesa cannot draw.
Picture draw_picture(const Scene& scene, const ViewState& state, int width, int height);

void write_png(const Picture& picture, formats::Output& output);

}  // namespace hexpipe::viewmesh
