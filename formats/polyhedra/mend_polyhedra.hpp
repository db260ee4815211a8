#pragma once
// Mends a mesh until OpenFOAM's checkMesh says "Mesh OK", by polyhedra in place of cells that it counts as wrong.

#include <array>
#include <cstdint>
#include <optional>
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
  std::int64_t halved = 0;                       // cells, with the whole of their sheets
  std::int64_t cut = 0;                          // cells, each alone
  std::int64_t merged = 0, polyhedra = 0;        // cells that merged, and into how many polyhedra
  std::int64_t moves = 0;                        // of vertices
  std::int64_t left_out = 0;                     // flat cells at the boundary
  double left_out_volume = 0;                    // their share of the volume, from 0 to 1
  double hexes_before = 0, hexes = 0;            // shares of the volume in hexes, from 0 to 1
  std::int64_t refused_before = 0, refused = 0;  // cells and faces with something wrong
  bool ended_early = false;                      // at the limit of work

  bool changed() const { return halved + cut + merged + left_out + moves > 0; }
};

// Halves hexes and prisms of a single layer between two facets of the boundary, whose determinant is low. All cells of
// the sheet are halved that share a halved edge, so hexes stay hexes. At the end of a sheet, the two halves of a side
// belong to one cell that stays whole; there the side bends a little, so that this cell is convex. Sheets that meet
// themselves stay whole. Returns the number of halved cells.
std::int64_t split_single_layers(MeasuredMesh& mesh, std::vector<LayerCell> cells,
                                 const MeasuredMesh::Refused& refused);

// Calls split_single_layers(), and then tries for each cell that is wrong, or has a wrong face, until one helps:
//   1. a vertex moves
//   2. cells merge to a polyhedron without hexes
//   3. the cell is cut in two, or cells merge with hexes, whichever takes less volume of hexes
//   4. the cell is left out, if it is flat and at the boundary
//   5. several vertices move, of the cell or of a polyhedron around it
//   6. the cell is left out, and a cell behind it is mended by 1 to 5
// Hexes become polyhedra only in the last of three passes, up to a thousandth of the volume. Regions, tagged facets
// between cells, and borders between surfaces stay. `cells` has all hexes and prisms.
//
// After `most_measurements` calls of MeasuredMesh::measure_cell(), by default two million and two for each cell of the
// mesh, it begins with no other cell or face: in thin layers at walls thousands are wrong, and nothing helps. The default
// is 4 to 15 s; spot, which takes the longest of the models of tests/bench/checkmesh.py, needs 1.3 million.
//
// If anything has changed, cells have new numbers: halves follow each other, and a polyhedron has the place of the
// first of its cells.
MendCounts mend_polyhedra(PolyhedralMesh& mesh, const std::vector<LayerCell>& cells,
                          std::optional<std::int64_t> most_measurements = std::nullopt);

// A line for the user that says what was done, and what is left; empty if nothing was wrong.
std::string summary(const MendCounts& counts);

}  // namespace hexpipe::polyhedra
