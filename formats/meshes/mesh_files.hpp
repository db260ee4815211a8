#pragma once
// The mesh formats behind one reader and one writer. Each format has a file pair of its own; this one tells them apart.

#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// The format is told by content: MEDIT .mesh, Gmsh .msh 2.2 and 4.1 (ASCII, binary), VTK legacy, VTU, TetGen .node with
// its .ele (and .face) beside it. Vertices that no cell uses are kept. `names`, if not null, gets those of tags, where
// the format has names. Throws FormatError or DataError.
MixedMesh read_mixed_mesh(Input& input, GroupNames* names = nullptr);

// Writes in the named format: mesh, msh (4.1 ASCII), msh-binary, msh22, msh22-binary, vtk, vtu, inp.
void write_mixed_mesh(const MixedMesh& mesh, std::string_view format, Output& output);

// All format names that write_mixed_mesh knows; the ending of a file is one of mesh, msh, vtk, vtu, inp.
const std::vector<std::string_view>& mesh_format_names();

}  // namespace hexpipe::formats
