#pragma once
// Writes surfaces to files for other meshers.

#include <string>
#include <string_view>
#include <vector>

#include "formats/streams/output.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::tessellate {

// The endings of files: obj, stl and msh.
const std::vector<std::string_view>& surface_format_names();

// OBJ: a group for each tag. STL: a solid in ASCII for each. .msh: physical surfaces. Returns, in sentences, how names
// had to be changed.
std::vector<std::string> write_surface(const formats::SurfaceSoup& surface, std::string_view format,
                                       formats::Output& output);

}  // namespace hexpipe::tessellate
