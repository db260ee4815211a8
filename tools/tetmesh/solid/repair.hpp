#pragma once
// Turns a triangle soup with few faults into the boundary of a solid, and counts the repairs.

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
  // For example "3 points welded, 1 hole filled by 2 triangles".
  std::string sentence() const;
};

nlohmann::ordered_json to_json(const RepairReport& report);

// Repairs in this order:
// - welds points;
// - removes triangles without area; if the corners of one are distinct, the neighbour at its longest side is cut in
// two;
// - removes repeated triangles;
// - turns triangles until neighbours agree, as most triangles of their component do;
// - fills holes: hole_filling.hpp;
// - turns closed components outward that do not lie in another one.
// Faults that it cannot mend stay, and check_surface() names them. Throws DataError if no triangle is left.
RepairReport repair(formats::SurfaceSoup& soup, const RepairOptions& options);

}  // namespace hexpipe::tetmesh::solid
