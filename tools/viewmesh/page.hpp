#pragma once
// Writes the page: one HTML file with the scene, its script and its style, which needs no network.

#include <string>

#include "formats/streams/output.hpp"
#include "tools/viewmesh/scene.hpp"
#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh {

// `title` is shown above the counts; `state` is how the page opens.
void write_page(const Scene& scene, const ViewState& state, const std::string& title, formats::Output& output);

// Arrays as the page reads them: base64 of a zlib stream of bytes, first the lowest byte of all numbers, then the next
// byte of all numbers, and so on. An integer is written as its difference n to the one `stride` before it, as 2n or -2n
// - 1.
std::string pack_integers(const std::vector<std::int32_t>& numbers, int stride);
std::string pack_floats(const std::vector<float>& numbers);

}  // namespace hexpipe::viewmesh
