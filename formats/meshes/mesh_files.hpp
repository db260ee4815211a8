#pragma once
// One reader and one writer for all mesh formats. Each format has its own pair of files; this pair tells them apart.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"
#include "formats/streams/output_folder.hpp"

namespace hexpipe::formats {

// Recognises the format by the content: MEDIT .mesh, Gmsh .msh 2.2 and 4.1 (ASCII, binary), VTK legacy, VTU, TetGen
// .node with its .ele (and .face) beside it, SU2, Nastran bulk data, Abaqus, Exodus II, MED. Keeps vertices that no
// cell uses. `names`, if not null, gets those of tags, where the format has names; `warnings`
// a sentence for everything that was mended or is doubtful. Throws FormatError or DataError.
MixedMesh read_mixed_mesh(Input& input, GroupNames* names = nullptr, std::vector<std::string>* warnings = nullptr);

// Writes in the named format: mesh, msh (4.1 ASCII), msh-binary, msh22, msh22-binary, vtk, vtu, inp, su2, bdf, nas,
// and where they were built: exo, e, med, cgns.
void write_mixed_mesh(const MixedMesh& mesh, std::string_view format, Output& output, const MeshWriting& writing = {});

// Whether the format has elements of second order.
bool takes_second_order(std::string_view format);

// All format names that write_mixed_mesh knows. The endings of files are those without a hyphen, except msh22.
const std::vector<std::string_view>& mesh_format_names();

// The format that is a folder of files, OpenFOAM's. Folders of this name have it.
inline constexpr std::string_view poly_mesh_format = "polyMesh";
std::unique_ptr<OutputFolder> open_mesh_folder(const std::string& path);
// Does not commit.
void write_mesh_folder(const MixedMesh& mesh, OutputFolder& folder, const MeshWriting& writing = {});

}  // namespace hexpipe::formats
