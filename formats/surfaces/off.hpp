#pragma once
// OFF, Geomview's object file format: ASCII, in three dimensions.

#include <string>
#include <string_view>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

// True for OFF and its variants with normals, colours or texture coordinates (NOFF, COFF, STOFF, STCNOFF, ...), and for
// the variants of other dimensions (4OFF, nOFF), which read_off rejects by name.
bool is_off_keyword(std::string_view word);

// Skips everything after a vertex's coordinates or a face's corners on their line. The count of edges may be missing.
SurfaceSoup read_off(std::string_view text, const std::string& name);

}  // namespace hexpipe::formats
