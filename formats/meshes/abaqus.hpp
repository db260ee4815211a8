#pragma once
// Writes Abaqus input. See formats/README.md.

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Regions become element sets, surface tags element-based surfaces. Throws DataError when a facet belongs to no cell,
// as it has no name then. Qualities are not written.
void write_abaqus(const MixedMesh& mesh, Output& output);

}  // namespace hexpipe::formats
