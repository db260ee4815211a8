#pragma once
// Reads surfaces in mesh formats: the triangles and quads of files without cells.

#include <cstddef>
#include <string_view>

#include "formats/streams/group_names.hpp"
#include "formats/streams/input.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

// Enough of the first bytes: Nastran's may be comments.
inline constexpr std::size_t bytes_that_tell_mesh = 1 << 16;

// Whether the first bytes are those of a mesh format that can be told by them. No surface format begins like these.
bool looks_like_mesh_surface(std::string_view bytes);

// Throws DataError if the file has cells, because tetmesh makes these itself.
SurfaceSoup read_mesh_surface(Input& input);

}  // namespace hexpipe::formats
