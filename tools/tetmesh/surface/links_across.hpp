#pragma once
// What the triangles of a surface see of those that face them across the inside of a part.

#include <cstdint>
#include <span>
#include <vector>

#include "tools/tetmesh/surface/opposite_sides.hpp"
#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// Weights are to be compared with those of SurfaceLinks.
class LinksAcross {
 public:
  // Without those to an opposite side whose directions differ, or which has many more or fewer rows, because both sides
  // bend or sizes differ.
  LinksAcross(const SurfaceLinks& links, std::span<const OppositeSide> opposite);

  std::span<const SurfaceLink> of(std::int32_t triangle) const {
    return std::span(links_).subspan(offsets_[triangle], offsets_[triangle + 1] - offsets_[triangle]);
  }

 private:
  std::vector<std::int64_t> offsets_;  // triangles + 1
  std::vector<SurfaceLink> links_;     // both ways
};

}  // namespace hexpipe::tetmesh::surface
