#pragma once
// Places where a surface intersects itself in a few triangles: folded slivers, corners that poke through.

#include <cstddef>

#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::tetmesh::solid {

struct FoldReport {
  std::size_t places = 0, triangles = 0;  // triangles that were replaced
};

// Takes the triangles that intersect out, together with as few around them as leave a hole with one simple border, and
// fills the hole; its inner points go. A place is mended only if the new triangles intersect nothing and old and new
// ones are within `tolerance` of each other, so that bodies that overlap stay as they are. Leaves places with borders
// or with edges of more than two triangles.
FoldReport remove_folds(formats::SurfaceSoup& soup, double tolerance);

}  // namespace hexpipe::tetmesh::solid
