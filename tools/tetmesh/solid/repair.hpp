#pragma once
// Makes a triangle soup the boundary of a solid where little is wrong with it, and counts what was done.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::tetmesh::solid {

struct RepairOptions {
  double tolerance = 0;           // points this near to each other become one
  std::size_t largest_hole = 30;  // in edges
};

struct RepairReport {
  std::size_t welded_points = 0;
  std::size_t degenerate_triangles = 0, duplicate_triangles = 0;  // removed
  std::size_t turned_triangles = 0;
  std::size_t filled_holes = 0, hole_triangles = 0;

  bool anything() const {
    return welded_points + degenerate_triangles + duplicate_triangles + turned_triangles + filled_holes > 0;
  }
  // "3 points welded, 1 hole filled by 2 triangles"
  std::string sentence() const;
};

nlohmann::ordered_json to_json(const RepairReport& report);

// In this order: welds points; removes triangles without area, cutting the neighbour at the longest side of one whose
// corners are distinct; removes repeated triangles; turns triangles until neighbours agree, as most of their piece do;
// fills holes with the triangulation of least area; turns closed pieces that lie in no other outward. What it cannot
// mend stays, for check_surface to name. Throws DataError where no triangle is left.
RepairReport repair(formats::SurfaceSoup& soup, const RepairOptions& options);

}  // namespace hexpipe::tetmesh::solid
