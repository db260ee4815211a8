#pragma once
// Edges without a length, and those that are shorter than triangles may be off, where these cross each other.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/joined_sets.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::tessellate {

// CAD has slivers with points at one place but for rounding, between which triangles are flat; TetGen takes such points
// for one. Joins the ends of edges that are no longer than 1e-8 of the diagonal of all nodes, even where sheets then
// touch. Returns how many.
std::size_t join_ends_without_length(std::span<const Triangle> triangles, std::span<const Vec3> nodes,
                                     JoinedSets& same);

// The triangles of one body that cross each other, in pairs. Bodies that touch or overlap do so however fine they are.
std::vector<std::array<std::int32_t, 2>> crossings_of_bodies(const formats::SurfaceSoup& surface);

// CAD has steps and slivers that are thinner than its own tolerance, and runs over itself there. Edges of at most this
// length, of triangles that cross, become a point, the shortest first, until none of one body cross. Returns the number
// of edges; 0, and leaves the surface as it is, if that does not help. Curves follow; triangles go in the order that
// they had.
std::size_t collapse_short_edges(formats::SurfaceSoup& surface, double longest);

}  // namespace hexpipe::tessellate
