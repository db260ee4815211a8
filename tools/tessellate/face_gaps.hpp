#pragma once
// What OpenCASCADE's triangles leave open between the edges of a face. Where two edges of a face run into a tip, they
// are as near to its surface as their tolerance asks for, which may be so little that their polygons cross there. Then
// BRepMesh leaves out the tip, or the whole face, though the faces beside it have triangles at these edges.

#include <TopoDS_Face.hxx>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::tessellate {

using NodeEdge = std::pair<std::int32_t, std::int32_t>;

// Nodes are numbered as in the list that is given.
struct FilledGaps {
  std::vector<NodeEdge> joins;      // pairs of nodes that become one, for edges of a tip are no further apart than that
  std::vector<Triangle> triangles;  // those that were missing
  std::vector<Vec3> nodes;          // new ones, on the face, whose numbers follow
  bool are_closed = true;           // false: a gap stays
  Vec3 place{};                     // of the gap that stays
};

// Closes the gaps between the triangles of a face (maybe none) and its border, the edges of its wires with the face on
// their left (or a wire with it on its right, where there are triangles to tell), by triangles within `deviation`, and
// the tolerance of its edges, of the face.
FilledGaps fill_gaps(const TopoDS_Face& face, std::span<const NodeEdge> border, std::span<const Triangle> triangles,
                     const std::vector<Vec3>& nodes, double deviation);

}  // namespace hexpipe::tessellate
