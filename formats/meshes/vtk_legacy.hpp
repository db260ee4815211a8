#pragma once
// VTK legacy files with an unstructured grid or polygons. See formats/README.md.

#include <string_view>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

bool looks_like_vtk_legacy(std::string_view text);

// Reads versions 1.0 to 5.1, ASCII and binary. Throws FormatError or DataError.
MixedMesh read_vtk_legacy(std::string_view text, std::string_view file);

// Writes version 3.0 in ASCII, which gmsh, meshio, VTK and HexaLab all read.
void write_vtk_legacy(const MixedMesh& mesh, Output& output);

}  // namespace hexpipe::formats
