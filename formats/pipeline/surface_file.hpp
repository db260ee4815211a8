#pragma once
// A surface in a file of any kind: of a surface format, of a mesh format, or a bundle.

#include <string>

#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::pipeline {

formats::SurfaceSoup read_surface_file(const std::string& path);

}  // namespace hexpipe::pipeline
