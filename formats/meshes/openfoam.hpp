#pragma once
// OpenFOAM's polyMesh, a folder of files; written only. See formats/README.md.

#include <memory>
#include <string>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/output_folder.hpp"

namespace hexpipe::formats {

// The folder for write_openfoam; what is there already must be a polyMesh or empty.
std::unique_ptr<OutputFolder> open_poly_mesh(const std::string& path);

// Surfaces become patches and, where cells are on both sides, zones of faces; regions become zones of cells. Faces
// between cells come first, as OpenFOAM orders them. Throws DataError if a facet belongs to no cell, a face has three
// cells, or a quad faces two triangles. Does not commit.
void write_openfoam(const MixedMesh& mesh, const MeshWriting& writing, OutputFolder& folder);

}  // namespace hexpipe::formats
