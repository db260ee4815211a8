#pragma once
// A surface on which more than two triangles meet at some edges, cut along these edges into sheets that are manifolds.

#include <utility>
#include <vector>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::surface {

// Two triangles at an edge of more than two stay together if they are beside each other and have the same regions on
// their sides, like those of a body that touches another one in the edge. The other triangles part there, and so do
// baffles, which have the same region on both sides. An edge of a single triangle, where a baffle ends, is a joint,
// too. A vertex gets a copy for each sheet of its triangles, also where sheets touch in the vertex alone.
struct SheetCut {
  std::vector<Triangle> triangles;  // of the vertices below
  std::vector<Vertex> point_of;     // by vertex: its point of the surface; the two numbers are the same where possible
  std::vector<std::pair<Vertex, Vertex>> joints;  // the edges of other than two triangles, once for each sheet's side
  bool is_manifold = true;                        // false: a sheet meets itself along an edge
};

SheetCut cut_along_joints(const solid::Surface& surface);

}  // namespace hexpipe::tetmesh::surface
