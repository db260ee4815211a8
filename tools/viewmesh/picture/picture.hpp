#pragma once
// Draws the picture that the page shows without a browser: Mesa runs the same shaders in memory.

#include <string>

#include "formats/streams/output.hpp"
#include "tools/viewmesh/picture/canvas.hpp"
#include "tools/viewmesh/scene.hpp"
#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh::picture {

// `title` stands in the legend. Throws DataError when Mesa cannot draw.
Picture draw_picture(const Scene& scene, ViewState state, const std::string& title, int width, int height);

void write_png(const Picture& picture, formats::Output& output);

}  // namespace hexpipe::viewmesh::picture
