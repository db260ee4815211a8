#pragma once
// SU2's native mesh format. See formats/README.md.

#include <string_view>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

bool looks_like_su2(std::string_view text);

// Markers become surfaces, numbered from 1 in their order, except markers whose name has a tag (surface_5). The format
// has no regions: all cells are in region 1. Throws FormatError or DataError.
MixedMesh read_su2(std::string_view text, std::string_view file, GroupNames* names = nullptr);

// Surfaces become markers. Regions and qualities are not written.
void write_su2(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

}  // namespace hexpipe::formats
