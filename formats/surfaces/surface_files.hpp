#pragma once
// Reads a surface from a file in any of the known formats.

#include "formats/streams/input.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

// Recognises the format by the content. Throws FormatError or DataError that names the line or the facet.
// pipeline/surface_bundle.hpp reads the surfaces of bundles.
SurfaceSoup read_surface(Input& input);

}  // namespace hexpipe::formats
