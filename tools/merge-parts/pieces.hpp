#pragma once
// Puts together the pieces that assemble made of the parts of a mesh.

#include <string>
#include <vector>

namespace hexpipe::merge_parts {

// Whether the bundle is such a piece.
bool is_piece(const std::string& path);

// Writes the mesh in one file, a bundle or another format by its ending; or, where it ends in .pvtu, this one and a
// .vtu of each piece in a folder of its name, and needs no more memory than for the largest piece and the facets
// between them. Throws DataError when one is missing, is of another mesh, comes twice, is not settled or was made with
// other options, or they do not fit together.
void merge_pieces(const std::vector<std::string>& paths, const std::string& output, bool compress);

}  // namespace hexpipe::merge_parts
