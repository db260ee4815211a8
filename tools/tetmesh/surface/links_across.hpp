#pragma once
// How the triangles of a surface see the triangles that face them across the inside of the model.

#include <cstdint>
#include <span>
#include <vector>

#include "tools/tetmesh/surface/opposite_sides.hpp"
#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// Its weights are comparable with those of SurfaceLinks.
class LinksAcross {
 public:
  // Leaves out links to an opposite side whose directions differ, or that has many more or fewer rows because the two
  // sides bend or their sizes differ.
  LinksAcross(const SurfaceLinks& links, std::span<const OppositeSide> opposite);

  std::span<const SurfaceLink> of(std::int32_t triangle) const {
    return std::span(links_).subspan(offsets_[triangle], offsets_[triangle + 1] - offsets_[triangle]);
  }
  std::span<SurfaceLink> of(std::int32_t triangle) {
    return std::span(links_).subspan(offsets_[triangle], offsets_[triangle + 1] - offsets_[triangle]);
  }

 private:
  std::vector<std::int64_t> offsets_;  // triangles + 1
  std::vector<SurfaceLink> links_;     // in both directions
};

}  // namespace hexpipe::tetmesh::surface
