#pragma once
// Abaqus input, which CalculiX reads, too; written only. See formats/README.md.

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Regions become element sets and node sets, surfaces node sets and element-based surfaces. Throws DataError when a
// facet is none of a cell, for then it cannot be named. Qualities are not written.
void write_abaqus(const MixedMesh& mesh, const MeshWriting& writing, Output& output);

}  // namespace hexpipe::formats
