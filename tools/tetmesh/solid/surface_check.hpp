#pragma once
// Checks that a triangle soup is the boundary of a solid. TetGen does not report such faults, or crashes on them.

#include <string_view>
#include <utility>

#include "common/run/error.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::tetmesh::solid {

// Two triangles meet elsewhere than in the vertices and edges that they share.
class SelfIntersection : public DataError {
 public:
  explicit SelfIntersection(DataError error) : DataError(std::move(error)) {}
};

// Throws DataError unless
// - coordinates are neither so large nor so small that volumes overflow or vanish,
// - no triangle is degenerate, and no two have the same corners,
// - each edge belongs to two triangles (closed), and each vertex to one fan of them (2-manifold),
// - neighbours agree in orientation, so that each shell is consistently oriented, outward or inward,
// - no two triangles meet elsewhere than in the vertices and edges that they share: SelfIntersection, where all else is
// well.
// The error names the first triangles or the first edge at fault and says how many faults there are. `remedy` ends the
// messages about faults that repair.hpp mends.
void check_surface(const formats::SurfaceSoup& soup, std::string_view remedy = {});

// For a surface whose sheets may meet: the first function checks that no triangle is degenerate, the second that no two
// intersect.
void check_areas(const formats::SurfaceSoup& soup, std::string_view remedy = {});
void check_intersections(const formats::SurfaceSoup& soup, std::string_view remedy);

}  // namespace hexpipe::tetmesh::solid
