#pragma once
// 3MF, as slicers and CAD programs write it for printers: a zip archive with models in XML (https://3mf.io/spec, core
// 1.3; parts in other files of the archive by the production extension, colours by the materials extension).

#include <string>
#include <string_view>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

// Whether the bytes begin like a zip archive and name a 3MF model.
bool looks_like_3mf(std::string_view bytes);

// Reads all objects that are to be built, where the archive places them, in millimetres. Each mesh placed is a group
// with its object's name, and so are triangles of other materials or colours than their object's. Throws DataError.
SurfaceSoup read_3mf(std::string_view bytes, const std::string& name);

}  // namespace hexpipe::formats
