#pragma once
// Makes the mesh conforming: each quad of a cell has another cell, a pyramid or the boundary on its other side.

#include <array>
#include <cstdint>

#include "common/mesh/candidates.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::conform {

// Why a cell went back to its tets.
enum class GivenBack : std::uint8_t {
  // The diagonal of a quad lies on the boundary or an interface, but the quad does not; or both do, around a hole.
  diagonal_on_surface,
  flat_corner,        // two boundary triangles leave no angle above the quad at a corner: no cell can be there
  diagonal_in_use,    // the cells around leave no ball of tets at the quad
  no_valid_position,  // no place of a new vertex gives good enough elements
  poor_elements,      // the new elements stayed poor or inverted when the vertices around moved
};
inline constexpr std::array all_reasons{GivenBack::diagonal_on_surface, GivenBack::flat_corner,
                                        GivenBack::diagonal_in_use, GivenBack::no_valid_position,
                                        GivenBack::poor_elements};
constexpr const char* name_of(GivenBack reason) {
  constexpr const char* names[] = {"diagonal_on_surface", "flat_corner", "diagonal_in_use", "no_valid_position",
                                   "poor_elements"};
  return names[static_cast<int>(reason)];
}

struct ConformityCounts {
  std::int64_t open_quads = 0;                                // at the start
  std::int64_t merged = 0;                                    // two tets became a pyramid
  std::int64_t split = 0;                                     // a new vertex split the tets around a diagonal
  std::int64_t absorbed = 0;                                  // slivers became part of a quad's bulge
  std::array<std::int64_t, all_reasons.size()> given_back{};  // cells
  double volume_given_back = 0;                               // of hexes
};

// `least_quality` is the worst scaled Jacobian that a new element may have: below 0, smoothing has to turn inverted
// ones.
ConformityCounts make_conforming(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags,
                                 const Candidates& candidates, double least_quality);

}  // namespace hexpipe::assemble::conform
