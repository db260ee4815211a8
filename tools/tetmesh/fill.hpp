#pragma once
// From a surface that bounds a solid to a mesh: makes its triangles anew, places points inside, calls TetGen, and
// places them again along the field that the first mesh carries.

#include "tools/tetmesh/shells.hpp"
#include "tools/tetmesh/tetmesh.hpp"

namespace hexpipe {

// `greatest_size` takes the place of options.size. With `estimates`, TetmeshStatistics::hex_share is there. Of the
// statistics, repair and seconds.checking stay empty. Throws TetGenFailure.
TetmeshResult fill(const Surface& given, const TetmeshOptions& options, double greatest_size, bool estimates);

}  // namespace hexpipe
