#pragma once
// Whether a triangle soup is the boundary of a solid: what TetGen does not say, or says by crashing.

#include <string_view>

#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::tetmesh::solid {

// Throws DataError, which names the first triangles or the first edge at fault and says how many there are, unless
// - coordinates are not so large or small that volumes overflow or vanish,
// - no triangle is degenerate and no two have the same corners,
// - each edge belongs to two triangles (closed), and each vertex to one fan of them (2-manifold),
// - neighbours agree in orientation, so that each shell is consistently oriented, outward or inward,
// - no two triangles meet elsewhere than in the vertices and edges that they share.
// `remedy` ends the messages about what repair.hpp mends.
void check_surface(const formats::SurfaceSoup& soup, std::string_view remedy = {});

// Of a surface whose sheets may meet as they like: no triangle is degenerate; and none intersects another.
void check_areas(const formats::SurfaceSoup& soup, std::string_view remedy = {});
void check_intersections(const formats::SurfaceSoup& soup);

}  // namespace hexpipe::tetmesh::solid
