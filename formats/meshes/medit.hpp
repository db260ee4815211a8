#pragma once
// MEDIT .mesh, the text format of Mmg, TetGen -g and others. See formats/README.md.

#include <string_view>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

bool looks_like_medit(std::string_view text);

// References become tags. Throws FormatError.
MixedMesh read_medit(std::string_view text, std::string_view file);

// Does not write qualities: the format has no place for them.
void write_medit(const MixedMesh& mesh, Output& output);

}  // namespace hexpipe::formats
