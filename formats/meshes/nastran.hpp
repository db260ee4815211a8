#pragma once
// Nastran bulk data. See formats/README.md.

#include <string_view>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

bool looks_like_nastran(std::string_view text);

// Properties become tags. Throws FormatError or DataError.
MixedMesh read_nastran(std::string_view text, std::string_view file, GroupNames* names = nullptr);

// Regions are properties of solids, surfaces of shells. Qualities are not written.
void write_nastran(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

}  // namespace hexpipe::formats
