#pragma once
// The last pass, where vertices have found their places: what is still poor becomes better where it can.

#include <cstdint>

#include "tools/assemble/gap/gap_mesh.hpp"

namespace hexpipe::assemble::gap {

// Looks at the cells below least_quality and those with a face that costs something, and fills the room around them
// anew or moves a vertex of theirs that is inside, while the objective falls; raises the worst cells at the vertices of
// a cell below least_quality together. Returns the number of changes. `gap` has to be valid, and stays so.
std::int64_t mend(GapMesh& gap);

}  // namespace hexpipe::assemble::gap
