#pragma once
// Writes Abaqus input, which CalculiX reads, too. See formats/README.md.

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Regions become element sets and node sets, surfaces become node sets and element-based surfaces. Throws DataError
// when a facet belongs to no cell, because it has no name then. Qualities are not written.
void write_abaqus(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

}  // namespace hexpipe::formats
