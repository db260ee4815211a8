#pragma once
// Abaqus input, written only. See formats/README.md.

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Regions become element sets, surface tags element-based surfaces. Throws DataError when a facet is none of a cell,
// for then it cannot be named. Qualities are not written.
void write_abaqus(const MixedMesh& mesh, Output& output);

}  // namespace hexpipe::formats
