#pragma once
// From a surface that bounds a solid to a mesh: makes its triangles anew, places points inside, calls TetGen, and
// places them again along the field that the first mesh carries.

#include <optional>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"
#include "tools/tetmesh/tetmesh.hpp"

namespace hexpipe::tetmesh {

// The sizes given by place, and those of walls, if they count, for so many layers.
sizing::SizeField size_field(const solid::Surface& surface, const TetmeshOptions& options, double greatest,
                             std::optional<int> layers);

// Whether it is plain that the points along the frame field give more hexes than the lattice's, so that nothing needs
// to be estimated: where much of the part is turned out of the lattice's axes, on a surface made anew. `tets`: of the
// mesh with the lattice's points.
bool frame_plainly_wins(bool remeshed, double turned_share, std::size_t tets);

// A mesh and what it was made of.
struct FilledSurface {
  std::optional<solid::Surface> made_surface;  // nothing: the given one
  sizing::SizeField size;
  tetgen::BuiltMesh built;
  TetmeshResult result;  // without the mesh, and what describes it

  const solid::Surface& surface(const solid::Surface& given) const { return made_surface ? *made_surface : given; }
};

// `size` takes the place of options.size and is what size_field() makes of the others. With `estimates`,
// TetmeshStatistics::hex_share is there. Of the statistics, repair and seconds.checking stay empty. Throws
// TetGenFailure.
FilledSurface fill(const solid::Surface& given, const TetmeshOptions& options, sizing::SizeField size, bool estimates);

// Describes the mesh, and moves it to where it is wanted.
TetmeshResult finish(FilledSurface filled, const solid::Surface& given);

}  // namespace hexpipe::tetmesh
