#pragma once
// Polyhedra in place of cells that OpenFOAM's checkMesh counts as wrong, so that it has nothing to say against the
// mesh.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "formats/polyhedra/measured_mesh.hpp"

namespace hexpipe::polyhedra {

// A hex or prism of the mesh, by its corners as cell_topology.hpp numbers them; a prism has six.
struct LayerCell {
  std::int32_t cell;
  CellKind kind;
  std::array<Vertex, 8> corners;
};

struct MendCounts {
  std::int64_t halved = 0, cut = 0;              // cells that were halved in sheets, and that were cut alone
  std::int64_t merged = 0, into = 0;             // cells that became parts of polyhedra; the number of these polyhedra
  std::int64_t moved = 0;                        // vertices
  std::int64_t left_out = 0;                     // flat cells at the boundary
  double left_out_volume = 0;                    // their share of the volume
  double hexes_before = 0, hexes = 0;            // their share of the volume
  std::int64_t refused_before = 0, refused = 0;  // cells and faces with something wrong

  bool changed() const { return halved + cut + merged + left_out + moved > 0; }
};

// Halves hexes and prisms of a single layer between two facets of the boundary, whose determinant is low, and with them
// all of the sheet in which edges are halved: hexes stay hexes. Where the sheet ends, the two halves of a side belong
// to one cell, and bend a little there so that this cell is convex. Sheets that meet themselves stay whole. Returns how
// many cells were halved.
std::int64_t split_single_layers(MeasuredMesh& mesh, std::vector<LayerCell> cells,
                                 const MeasuredMesh::Refused& refused);

// The same; and then, for each cell that is wrong or has such a face, the first of these that helps: a vertex moves;
// cells merge to a polyhedron; the cell is cut in two; it is left out, where it is flat at the boundary; several
// vertices move, of the cell or of a polyhedron around it; it is left out and a cell behind it is mended.
// Hexes become polyhedra only if nothing else helps, up to a thousandth of the volume. Regions, facets between cells,
// and borders between surfaces stay. `cells` has all hexes and prisms.
//
// Cells get new numbers if something has changed: halves follow each other, and a polyhedron stands where the first of
// its cells stood.
MendCounts mend_polyhedra(PolyhedralMesh& mesh, const std::vector<LayerCell>& cells);

// A line for the user that says what was done, and what is left; empty if nothing was wrong.
std::string summary(const MendCounts& counts);

}  // namespace hexpipe::polyhedra
