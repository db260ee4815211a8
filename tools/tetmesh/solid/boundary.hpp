#pragma once
// A checked surface with what it bounds: the way from a soup to shells, or to sheets.

#include <string>
#include <string_view>
#include <vector>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

// Finds the shells of a soup, or its sheets where more than two triangles meet at an edge, or where baffles are kept
// and there are some. Adds a sentence to `warnings` for everything that it changed. Throws DataError where the soup is
// not the boundary of a solid; `remedy` ends the messages about faults that repair.hpp mends.
Surface boundary_of(formats::SurfaceSoup soup, ShellRule rule, BaffleRule baffles, std::string_view remedy,
                    std::vector<std::string>& warnings);

}  // namespace hexpipe::tetmesh::solid
