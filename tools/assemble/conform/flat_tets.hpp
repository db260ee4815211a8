#pragma once
// Better tets where moving vertices leaves them flat: flips, a vertex beside them, or none of them on the boundary.
// All of these judge a tet by its least scaled Jacobian times the square root of 2, which is 1 for the regular tet.

#include <cstdint>
#include <span>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::conform {

// Flips tets that are worse than `least`: other tets on the same vertices replace the tets around an edge, or those on
// both sides of a facet. Takes the flip after which the worst of these tets is best, if it is better at all, and goes
// on with the new tets. Cells, tagged facets and regions stay as they are. Returns the number of flips.
std::int64_t flip_poor_tets(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, double least);

// Inserts vertices: fills the cavity around each tet that is worse than `least` anew from a vertex inside, if that
// makes the worst tet there better. Returns the number of new vertices.
std::int64_t split_flat_tets(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, double least);

// Peels flat tets off the boundary: a tet that is worse than `least`, has two facets on a smooth part of the boundary
// and lies as near to the input's surface as most_deviation_at() allows is removed, and its other two facets become
// boundary. Tets with an edge between two shared vertices stay: `is_shared` as in Seam (extract.hpp), empty without a
// seam. Returns the number of tets removed.
std::int64_t peel_flat_tets(hybrid::HybridMesh& mesh, hybrid::SurfaceTags& tags, const shape::InputSurface& surface,
                            std::span<const std::uint8_t> is_shared, double least);

}  // namespace hexpipe::assemble::conform
