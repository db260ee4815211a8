#pragma once
// Surfaces that are no manifolds: bodies touch in faces, edges or vertices, or walls stand inside. They consist of
// sheets, which meet at edges of more than two triangles. A sheet with the same region on both sides is a baffle; it
// may end inside.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

// Whether an edge has more than two triangles, or, if all edges have two, a vertex has several fans of them.
bool meets_in_sheets(const formats::SurfaceSoup& soup);

struct SheetReport {
  std::size_t interface_triangles = 0;  // two bodies had them, and share them now
  std::size_t fins = 0;                 // removed triangles with the same region, or nothing, on both sides
  std::size_t baffles = 0;              // triangles that stay with the same region on both sides

  // The figures that are not 0, in sentences.
  std::vector<std::string> sentences() const;
};

// Finds the sides of a soup that does not tell them, by walking around each edge. A space between triangles is a region
// if a triangle has its back to it (ShellRule::oriented), or if it is closed (ShellRule::regions). Throws DataError for
// ShellRule::holes, for repeated triangles of the same orientation, for triangles with their backs to the outside,
// if nothing is enclosed, and where a body has a hole. `remedy` is said with what may be mended.
SheetReport find_sides(formats::SurfaceSoup& soup, ShellRule rule, BaffleRule baffles = BaffleRule::drop,
                       std::string_view remedy = {});

// The soup has sides. Bodies that have the same triangles where they touch share these afterwards.
SheetReport join_bodies(formats::SurfaceSoup& soup, BaffleRule baffles = BaffleRule::drop);

// Finds the sheets of a soup with sides; they take the place of shells. A triangle between two regions has the lower
// number behind it. The triangles of a baffle get one orientation; throws DataError if it has a single side, like
// Möbius' strip.
Surface find_sheets(formats::SurfaceSoup soup);

// Finds the shells of a soup, or its sheets where more than two triangles meet at an edge, or where baffles are kept
// and there are some. Adds a sentence to `warnings` for everything that it changed. Throws DataError where the soup is
// not the boundary of a solid; `remedy` ends the messages about faults that repair.hpp mends. Where shells have no
// other fault than that they intersect themselves, `mend_folds` may change them; if it leaves an intersection, the
// message is about the surface as it came.
Surface boundary_of(formats::SurfaceSoup soup, ShellRule rule, BaffleRule baffles, std::string_view remedy,
                    std::vector<std::string>& warnings,
                    const std::function<void(formats::SurfaceSoup&)>& mend_folds = {});

}  // namespace hexpipe::tetmesh::solid
