#pragma once
// Surfaces as they come: triangle soups from STL, OBJ, PLY and OFF, with the line or the offset of every triangle, so
// that later checks can name a place.

#include <cstdint>
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "formats/input.hpp"

namespace hexpipe {

struct SurfaceSoup {
  std::vector<Vec3> points;              // STL: one for each distinct coordinate triple (exact equality)
  std::vector<Triangle> triangles;       // polygons are fanned
  std::vector<std::int32_t> tags;        // surface tag: STL solid or attribute, OBJ group, else 0
  std::vector<std::int64_t> places;      // line (text) or facet number (binary) of each triangle, from 1
  bool text = true;                      // what `places` counts
  std::string name;                      // of the input, for messages
};

// The format is told by content. Throws FormatError or DataError naming line or facet.
SurfaceSoup read_surface(Input& input);

}  // namespace hexpipe
