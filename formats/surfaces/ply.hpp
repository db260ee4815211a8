#pragma once
// PLY, ASCII and binary of either byte order.

#include <string>
#include <string_view>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

bool looks_like_ply(std::string_view bytes);

// Skips elements other than vertex and face, and properties other than x, y, z and vertex_indices (or vertex_index).
// The place of a face is its line (ASCII) or its number (binary).
SurfaceSoup read_ply(std::string_view bytes, const std::string& name);

}  // namespace hexpipe::formats
