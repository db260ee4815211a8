#pragma once
// The lines along which rows of a lattice end inside a volume.

#include <array>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/volume/lattice_links.hpp"

namespace hexpipe::tetmesh::volume {

using LineSegments = std::vector<std::array<double, 6>>;  // both ends of each segment

// Lengths are in sizes, and count a line as many times as rows end along it.
struct Dislocations {
  LineSegments segments;
  double length = 0;
  double at_singularities = 0;   // of lines that end at a singularity of the frames, at one end at least
  double closed = 0;             // of lines that end nowhere
  std::size_t surface_ends = 0;  // rows that end on the surface
};

// Finds the lines of a lattice with these coordinates at the nodes, which are the vertices of the mesh. A line pierces
// a triangle if the whole numbers of rows from each of its corners to the next do not add up to zero. If the frames
// turn around the triangle, rows cannot be counted.
Dislocations find_dislocations(const LatticeLinks& links, std::span<const std::array<double, 3>> coordinates,
                               const TetMesh& mesh, const TetAdjacency& adjacency);

}  // namespace hexpipe::tetmesh::volume
