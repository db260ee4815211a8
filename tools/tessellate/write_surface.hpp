#pragma once
// Surfaces in files for other people's meshers.

#include <string>
#include <string_view>
#include <vector>

#include "formats/streams/output.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::tessellate {

// obj, stl and msh, by the ending of a file.
const std::vector<std::string_view>& surface_format_names();

// OBJ: a group for each tag; STL: a solid in ASCII for each; .msh: physical surfaces. Returns what had to be changed of
// the names, in sentences.
std::vector<std::string> write_surface(const formats::SurfaceSoup& surface, std::string_view format,
                                       formats::Output& output);

}  // namespace hexpipe::tessellate
