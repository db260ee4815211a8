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

// "wall=5", "3=5", "all=5" for everything on the boundary, or, for the side towards one region, "wall in water=5". "all
// in water=5": on all that bounds the region, interfaces too.
struct AskedWall {
  std::string name;  // as it is given, of the surface or its number
  int layers;
};

// The names that a mesh's tags have.
struct TagNames {
  std::map<std::int32_t, std::string> surfaces, regions;
};

// Reads "wall=5, lid=5". Names may have commas. Throws UsageError.
std::vector<AskedWall> parse_walls(std::string_view text);

// Walls by tag, ascending. A name of several surfaces or regions means all of them. `source` names the mesh in
// messages. Throws DataError where the mesh has no such surface or region, a surface does not bound the region, and
// where walls touch that have different numbers of layers.
std::vector<WallGroup> find_walls(std::span<const AskedWall> asked, const TetMesh& mesh, const TagNames& names,
                                  std::string_view source);

}  // namespace hexpipe::assemble::layers
