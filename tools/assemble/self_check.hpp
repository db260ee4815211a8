#pragma once
// The proof that a result is what assemble promises, made from the result itself before anything is written.

#include <cstdint>

#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/extract.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble {

// They add up: parts = skin = input + bulge + open_bulge + slide - peeled, but for rounding.
struct CheckedVolumes {
  double input = 0;        // of the tets
  double parts = 0;        // of the cells, with bilinear sides
  double skin = 0;         // enclosed by the facets that one cell has
  double bulge = 0;        // of boundary quads over the two triangles that they replace
  double open_bulge = 0;   // of non-conforming quads over the tets that they face
  double slide = 0;        // what the input's triangles enclose more since vertices slid on its surface
  double peeled = 0;       // of the flat tets that were taken off the boundary
  double drift = 0;        // parts - input - bulge - open_bulge - slide + peeled: rounding
  double deviation = 0;    // greatest distance of the boundary from the input's surface (boundary_deviation.hpp)
  std::int64_t moved = 0;  // vertices on the boundary and on interfaces
  std::int64_t nonconforming_quads = 0;
};

// Throws DataError when a cell is not valid everywhere, a facet has more than two cells or two on the same side, a
// facet of one cell or between two regions is not tagged, a tagged facet is none of a cell, a vertex is unused, or
// a vertex of the boundary is not on the input's surface, volumes do not add up; and, for a conforming result, when a
// quad faces two triangles.
CheckedVolumes check_result(const hybrid::Extract& result, const TetMesh& input, const hybrid::SurfaceTags& tags,
                            const shape::InputSurface& surface, bool conforming);

}  // namespace hexpipe::assemble
