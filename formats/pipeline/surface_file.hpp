#pragma once
// Surfaces in files: read from any kind, of a surface format, of a mesh format, or a bundle; written as a bundle for
// tetmesh, or in a format for other meshers.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "formats/pipeline/exact_shape.hpp"
#include "formats/streams/output.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::pipeline {

// `history` gets the entries of a bundle's history, in their order.
formats::SurfaceSoup read_surface_file(const std::string& path, std::vector<nlohmann::ordered_json>* history = nullptr);

// The format of a file by its ending: obj, stl or msh; empty for a bundle. Throws UsageError for other endings, and
// where a bundle would go to a terminal.
std::string_view surface_format_of(const std::string& path);

// OBJ: a group for each tag. STL: a solid in ASCII for each. .msh: physical surfaces. Returns, in sentences, how names
// had to be changed.
std::vector<std::string> write_surface(const formats::SurfaceSoup& surface, std::string_view format,
                                       formats::Output& output);

// A bundle with this history, whose last entry is that of the tool that runs. `shape`: the CAD's faces from which the
// surface comes.
void write_surface_bundle(const formats::SurfaceSoup& surface, const std::vector<nlohmann::ordered_json>& history,
                          bool compress, formats::Output& output, const ExactShape* shape = nullptr);

}  // namespace hexpipe::pipeline
