#pragma once
// STL, ASCII and binary.

#include <string>
#include <string_view>

#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::formats {

// True when the length fits the count in a binary header. ASCII cannot match by accident: four letters, read as a
// count, are hundreds of millions of facets.
bool is_binary_stl(std::string_view bytes);

// There may be several solids, whose numbers (from 1) become the tags. Normals are skipped; keywords may have any case.
SurfaceSoup read_ascii_stl(std::string_view text, const std::string& name);

// The facets' attributes become the tags. Throws DataError when the length is not 84 + 50 n or a coordinate is not
// finite.
SurfaceSoup read_binary_stl(std::string_view bytes, const std::string& name);

}  // namespace hexpipe::formats
