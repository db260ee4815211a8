#pragma once
// Gmsh's .msh, versions 2.2 and 4.1, ASCII and binary. See formats/README.md.

#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

enum class MshVersion { v2_2, v4_1 };
enum class MshCoding { ascii, binary };

bool looks_like_msh(std::string_view text);

// Physical groups become tags; in a dimension without groups, elementary entities do. Elements come in the order of
// their numbers, nodes in the order of the file. `names`, if not null, gets those of groups. Throws FormatError or
// DataError.
MixedMesh read_msh(std::string_view text, std::string_view file, GroupNames* names = nullptr);

// A mesh with a value at each of its points, from the first $NodeData section of one component; NaN at points without a
// value. Reading it also throws when there is no such section.
struct MshNodeValues {
  MixedMesh mesh;
  std::vector<double> values;
};
MshNodeValues read_msh_node_values(std::string_view text, std::string_view file);

// Regions and surfaces become physical groups. In version 2.2 no surface has the number of a region, because its readers
// mix them up. The quality becomes a post-processing view; version 2.2 has none, because meshio cannot open mixed meshes
// with one.
void write_msh(const MixedMesh& mesh, MshVersion version, MshCoding coding, const MeshWriting& writing, Output& output);

}  // namespace hexpipe::formats
