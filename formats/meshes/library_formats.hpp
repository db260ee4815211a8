#pragma once
// Formats that are read and written by libraries: Exodus II, MED, CGNS (written only). See formats/README.md.

#include <string>
#include <string_view>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Regions become element blocks, one for each kind of cells; surfaces become sets of sides and of nodes. Throws
// DataError where a facet is none of a cell. Qualities are not written.
void write_exodus(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

// Regions and surfaces become groups of elements. Qualities are not written.
void write_med(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

// Regions become sections, one for each kind of cells; surfaces become sections, boundary conditions and families.
// Qualities are not written.
void write_cgns(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

// Whether the bytes are in one of these formats. Then read_by_library reads them; it throws DataError if this build
// lacks the format. `path` is that of the file that has the bytes; without a file, as in a pipe, they are copied.
bool looks_like_library_format(std::string_view bytes);
MixedMesh read_by_library(std::string bytes, const std::string& name, const std::string& path,
                          GroupNames* names = nullptr);

}  // namespace hexpipe::formats
