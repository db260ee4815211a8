#pragma once
// Reads TetGen's .node with .ele and, if there is one, .face beside it. See formats/README.md.

#include <string>
#include <string_view>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::formats {

bool looks_like_tetgen(std::string_view text);

// `text` is the content of the .node or the .ele file at `path`; the other files are read from beside it. Messages name
// the file `name`. Throws FormatError or DataError, also when `path` is empty (standard input).
MixedMesh read_tetgen(std::string_view text, const std::string& name, const std::string& path);

}  // namespace hexpipe::formats
