#pragma once
// Wavefront OBJ: vertices and faces.

#include <string>
#include <string_view>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

// Knows every statement of polygonal OBJ and obeys v, f, g and o. The groups and objects (g, o) that hold faces are
// numbered from 1 in the order of the file; their numbers become the tags.
SurfaceSoup read_obj(std::string_view text, const std::string& name);

// True for the first word of an OBJ statement.
bool is_obj_keyword(std::string_view word);

}  // namespace hexpipe::formats
