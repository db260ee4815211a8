#pragma once
// Reads surfaces in mesh formats: the triangles and quads of files without cells.

#include "formats/streams/group_names.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::formats {

// Whether the first bytes are those of MEDIT, Gmsh, VTK or VTU. No surface format begins like these.
bool looks_like_mesh_surface(std::string_view bytes);

// Throws DataError if the file has cells, because tetmesh makes these itself.
SurfaceSoup read_mesh_surface(Input& input);

}  // namespace hexpipe::formats
