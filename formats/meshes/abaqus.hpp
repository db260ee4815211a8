#pragma once
// Abaqus input, which CalculiX takes, too. See formats/README.md.

#include <string_view>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

bool looks_like_abaqus(std::string_view text);

// Solids and shells of first order, and the corners of C3D10. Sets of elements become regions, those of *SOLID SECTION
// where there are any; surfaces of faces become surfaces. Throws FormatError or DataError.
MixedMesh read_abaqus(std::string_view text, std::string_view file, GroupNames* names = nullptr);

// Regions become element sets and node sets, surfaces become node sets and element-based surfaces. Throws DataError
// when a facet belongs to no cell, because it has no name then. Qualities are not written.
void write_abaqus(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

}  // namespace hexpipe::formats
