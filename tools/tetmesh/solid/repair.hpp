#pragma once
// Turns a triangle soup with few faults into the boundary of a solid, and counts the repairs.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/surfaces/surface_soup.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

struct RepairOptions {
  double tolerance = 0;           // points this near to each other become one
  std::size_t largest_hole = 30;  // in edges
};

struct RepairReport {
  std::size_t welded_points = 0;
  std::size_t cut_borders = 0;  // points on borders of triangles, which were cut there
  std::size_t degenerate_triangles = 0, duplicate_triangles = 0;  // removed
  std::size_t stray_triangles = 0;                                // removed
  std::size_t turned_triangles = 0;
  std::size_t filled_holes = 0, hole_triangles = 0;
  std::size_t mended_folds = 0, fold_triangles = 0;  // places where the surface intersected itself; replaced

  bool anything() const {
    return welded_points + cut_borders + degenerate_triangles + duplicate_triangles + stray_triangles +
               turned_triangles + filled_holes + mended_folds >
           0;
  }
  // For example "3 points welded, 1 hole filled by 2 triangles".
  std::string sentence() const;
};

nlohmann::ordered_json to_json(const RepairReport& report);

// Mends what changes no shape and needs no guess, where the surface is not closed or has triangles without area or
// repeated ones; other surfaces stay as they are:
// - removes triangles without area, as repair() does, and copies of triangles of the same orientation;
// - makes one point of points of borders that differ by rounding, cuts triangles where other points lie on their
// borders, and removes stray sheets, if no border is left then: borders.hpp. Where the surface says what is on its
// sides, only triangles without area go. Where baffles are kept, sheets are no strays, and borders may be left.
RepairReport mend(formats::SurfaceSoup& soup, BaffleRule baffles = BaffleRule::drop);

// Makes triangles anew where a few intersect, as repair() does, but only where the surface stays what it is to within a
// hundredth of the size that suits it, and keeps its components, handles and tags. Counts this in `report`.
void mend_folds(formats::SurfaceSoup& soup, RepairReport& report);

// Mends, and repairs in this order:
// - welds points;
// - removes triangles without area; if the corners of one are distinct, the neighbour at its longest side is cut in
// two;
// - removes repeated triangles;
// - turns triangles until neighbours agree, as most triangles of their component do;
// - fills holes: fill_hole();
// - makes new triangles where few intersect: remove_folds();
// - turns closed components outward that do not lie in another one.
// Faults that it cannot mend stay, and check_surface() names them. Throws DataError if no triangle is left.
RepairReport repair(formats::SurfaceSoup& soup, const RepairOptions& options);

}  // namespace hexpipe::tetmesh::solid
