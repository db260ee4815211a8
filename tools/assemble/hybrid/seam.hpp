#pragma once
// Where the piece that is assembled ends and those of other parts begin: docs/definitions.md 5.

#include <cstdint>
#include <vector>

namespace hexpipe::assemble::hybrid {

struct Seam {
  // By vertex of the input: 1 where others have cells too, so that it stays where it is.
  std::vector<std::uint8_t> is_shared;
  // By candidate: 1 for a cell of another part (a guest). It is there so that a quad of it that faces tets of this
  // piece gets its pyramid, or goes back to its tets.
  std::vector<std::uint8_t> is_guest;
  // The region of the guests' tets, and the tag of facets that only they have.
  std::int32_t guest_region = 0, guest_tag = 0;
  // The tag of facets where the piece ends inside the mesh, and of tagged ones that another piece writes.
  std::int32_t seam_tag = 0;
};

}  // namespace hexpipe::assemble::hybrid
