#pragma once
// TetGen's .node with .ele and, where it is there, .face beside it. See formats/README.md.

#include <string>
#include <string_view>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::formats {

bool looks_like_tetgen(std::string_view text);

// `text` is that of the .node or the .ele file at `path`; the others are read from beside it. `name` is the file's in
// messages. Throws FormatError or DataError, also when `path` is empty (standard input).
MixedMesh read_tetgen(std::string_view text, const std::string& name, const std::string& path);

}  // namespace hexpipe::formats
