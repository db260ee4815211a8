#pragma once
// Surfaces in mesh formats: their triangles and quads, where there are no cells.

#include "formats/streams/group_names.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::formats {

// Whether it is MEDIT, Gmsh, VTK or VTU by its first bytes, in which no surface format begins.
bool looks_like_mesh_surface(std::string_view bytes);

// Throws DataError where the file has cells: tetmesh makes these itself.
SurfaceSoup read_mesh_surface(Input& input);

}  // namespace hexpipe::formats
