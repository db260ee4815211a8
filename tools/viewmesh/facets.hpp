#pragma once
// Finds the cells that meet at each facet of a scene, and their sides.

#include <cstdint>
#include <span>
#include <vector>

#include "tools/viewmesh/scene.hpp"

namespace hexpipe::viewmesh {

// A cell's view of one of its facets. Cells that list the same vertices in opposite senses are on different sides.
struct FacetSide {
  std::array<std::int32_t, 4> key;  // vertices ascending; the first is no_index in a triangle
  std::int32_t cell;
  std::uint8_t facet;  // triangles of the topology first, then its quads
  std::uint8_t side;
};

// The vertices of a cell's facet counter-clockwise from outside, 3 or 4.
struct FacetCorners {
  std::array<std::int32_t, 4> vertices;
  int count;
};
int facet_count(CellKind kind);
FacetCorners facet_corners(const Scene& scene, std::int32_t cell, int facet);

// All sides of all facets; the sides of one facet stand together.
std::vector<FacetSide> facet_sides(const Scene& scene);

// Calls visit(span of FacetSide) for each facet.
template <class Visit>
void for_each_facet(std::span<const FacetSide> sides, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
    visit(sides.subspan(begin, end - begin));
  }
}

// By point: whether it is on the surface of the scene's cells, which must not overlap.
std::vector<bool> surface_points(const Scene& scene);

// By cell: 1 when it touches a point of the surface, otherwise one more than the lowest layer of the cells that it
// touches, at most 255.
std::vector<std::uint8_t> layers_from_surface(const Scene& scene, const std::vector<bool>& surface);

}  // namespace hexpipe::viewmesh
