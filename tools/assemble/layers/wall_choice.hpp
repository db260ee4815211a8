#pragma once
// Which walls the command line asks for.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/layers/walls.hpp"

namespace hexpipe::assemble::layers {

// "wall=5", "3=5", "all=5" for everything on the boundary, or, for one side of an interface, "wall in water=5".
struct AskedWall {
  std::string name;  // as it is given, of the surface or its number
  int layers;
};

// The names that a mesh's tags have.
struct TagNames {
  std::map<std::int32_t, std::string> surfaces, regions;
};

// Reads "wall=5, lid=5". Throws UsageError.
std::vector<AskedWall> parse_walls(std::string_view text);

// `source` names the mesh in messages. Throws DataError where the mesh has no such surface or region, and where walls
// touch that have different numbers of layers.
std::vector<WallGroup> find_walls(std::span<const AskedWall> asked, const TetMesh& mesh, const TagNames& names,
                                  std::string_view source);

}  // namespace hexpipe::assemble::layers
