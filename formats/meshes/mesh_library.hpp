#pragma once
// Formats that need a large library are modules of their own, loaded when a mesh is written or read so: the libraries'
// own libraries take a tool 30 to 60 ms to start.

#include <string_view>

#include "formats/meshes/grouped_mesh.hpp"

namespace hexpipe::formats {

// The functions of a module. They throw std::exception with the reason alone.
struct MeshLibrary {
  const char* version;  // of the hexpipe that it was built for
  void (*write)(const GroupedMesh& mesh, const std::string& path);
  GroupedMesh (*read)(const std::string& path);  // null: the format is written only
};

// The one function that a module exports.
inline constexpr const char* mesh_library_function = "hexpipe_mesh_library";

// The module of this name, which stays loaded. Throws DataError where it is not there.
const MeshLibrary& mesh_library(std::string_view name);

}  // namespace hexpipe::formats
