#pragma once
// Gmsh's .msh, versions 2.2 and 4.1, ASCII and binary. See formats/README.md.

#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

enum class MshVersion { v2_2, v4_1 };
enum class MshCoding { ascii, binary };

bool looks_like_msh(std::string_view text);

// Physical groups become tags; where a dimension has none, its elementary entities do. Elements come in the order of
// their numbers, nodes in that of the file. `names`, if not null, gets those of groups. Throws FormatError or
// DataError.
MixedMesh read_msh(std::string_view text, std::string_view file, GroupNames* names = nullptr);

// A mesh with a number at each of its points: those of the first $NodeData section of one component; NaN where it has
// none. Throws also where there is no such section.
struct MshNodeValues {
  MixedMesh mesh;
  std::vector<double> values;
};
MshNodeValues read_msh_node_values(std::string_view text, std::string_view file);

// Regions and surfaces are physical groups. The quality is a post-processing view; version 2.2 goes without, for meshio
// cannot open mixed meshes with one.
void write_msh(const MixedMesh& mesh, MshVersion version, MshCoding coding, Output& output);

}  // namespace hexpipe::formats
