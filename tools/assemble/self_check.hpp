#pragma once
// Checks a result from the result itself, before anything is written: it is what assemble promises.

#include <cstdint>
#include <map>
#include <span>

#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/extract.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble {

// They add up, to rounding: cells = skin = input + bulge + open_bulge + slide - peeled.
struct CheckedVolumes {
  double input = 0;        // the volume of the tets
  double cells = 0;        // the volume of the cells, with bilinear sides
  double skin = 0;         // the volume inside the facets that only one cell has
  double bulge = 0;        // between boundary quads and the two triangles that they replace
  double open_bulge = 0;   // between non-conforming quads and the tets that they face
  double slide = 0;        // how much more the input's triangles enclose since vertices slid on its surface
  double peeled = 0;       // the volume of the flat tets that were peeled off the boundary
  double drift = 0;        // cells - input - bulge - open_bulge - slide + peeled: rounding
  double deviation = 0;    // the greatest distance of the boundary from the input's surface (boundary_deviation.hpp)
  std::int64_t moved = 0;  // vertices on the boundary and on interfaces that moved
  std::int64_t nonconforming_quads = 0;
};

// Throws DataError if a cell is not valid everywhere, a facet has more than two cells or two on the same side, a facet
// of one cell or between two regions is not tagged, a tagged facet belongs to no cell, a vertex is unused, a vertex of
// the boundary is not on the input's surface, volumes do not add up, or, in a conforming result, a quad faces two
// triangles or a boundary quad has a triangle on one of its halves.
CheckedVolumes check_result(const hybrid::Extract& result, const TetMesh& input, const hybrid::SurfaceTags& tags,
                            const shape::InputSurface& surface, bool conforming);

using RegionVolumes = std::map<std::int32_t, double>;  // by region
RegionVolumes region_volumes(const MixedMesh& mesh);

// Volumes of a mesh before it got layers, to compare with those after.
struct BeforeLayers {
  RegionVolumes volumes;
  double deviation;  // the greatest distance of the boundary from the input's surface
};

// The same for a conforming mesh that has got layers. `origin`: points of layers have their feet's vertices in the
// input. Volumes: that inside the skin is that of the cells, to rounding; that of each region is what it was, but for
// what fits between its boundary and the input's surface, then and now. Returns the greatest distance of the boundary
// from the input's surface, at the middles of facets.
double check_layered(const MixedMesh& mesh, std::span<const Vertex> origin, const TetMesh& input,
                     const shape::InputSurface& surface, const BeforeLayers& before);

}  // namespace hexpipe::assemble
