#pragma once
// STL, ASCII and binary.

#include <string>
#include <string_view>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

// True when the length fits the count in a binary header. ASCII cannot match by accident: four letters, read as a
// count, are hundreds of millions of facets.
bool is_binary_stl(std::string_view bytes);
// Less strict: the count, or where it is 0 the length, is that of facets that may be some; bytes may follow.
bool may_be_binary_stl(std::string_view bytes);

// A binary STL of which the end is missing: fewer facets than it counts, which may be some.
bool is_cut_binary_stl(std::string_view bytes);

// There may be several solids, whose numbers (from 1) become the tags. Normals are skipped; keywords may have any case,
// and there may be a blank in those that begin with `end`.
SurfaceSoup read_ascii_stl(std::string_view text, const std::string& name);

// The facets' attributes become the tags. A warning reports bytes behind the facets, or a count of 0. Throws
// DataError when the file is too short, more facets follow, or a coordinate is not finite.
SurfaceSoup read_binary_stl(std::string_view bytes, const std::string& name);

}  // namespace hexpipe::formats
