#pragma once
// A surface on which more than two triangles meet at some edges, cut along these edges into pieces that are manifolds.

#include <utility>
#include <vector>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::surface {

// At an edge of more than two triangles two of them stay together where what is on their sides is the same, and they
// are beside each other: those of a body that touches another one in the edge. The others part there. A vertex whose
// triangles are in several pieces then, or touch in it alone, is there once for each: as copies.
struct SheetCut {
  std::vector<Triangle> triangles;                // of the vertices below
  std::vector<Vertex> point_of;                   // of each vertex, its point of the surface; its number where it can
  std::vector<std::pair<Vertex, Vertex>> joints;  // the edges of more than two triangles, once for each piece's side
  bool is_manifold = true;                        // false: a piece meets itself along an edge
};

SheetCut cut_along_joints(const solid::Surface& surface);

}  // namespace hexpipe::tetmesh::surface
