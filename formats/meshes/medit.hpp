#pragma once
// MEDIT .mesh, the text format of Mmg, TetGen -g and others. See formats/README.md.

#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

bool looks_like_medit(std::string_view text);

// References become tags. A file may lack its End, told in `warnings`, if not null. Throws FormatError.
MixedMesh read_medit(std::string_view text, std::string_view file, std::vector<std::string>* warnings = nullptr);

// Does not write qualities: the format has no place for them.
void write_medit(const MixedMesh& mesh, Output& output);

}  // namespace hexpipe::formats
