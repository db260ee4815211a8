#pragma once
// The groups of a scene: its regions and surfaces with their names, and the facets that lie on each surface.

#include <array>
#include <cstdint>
#include <vector>

#include "formats/streams/group_names.hpp"
#include "tools/viewmesh/scene.hpp"

namespace hexpipe::viewmesh {

// A triangle of the mesh's surface, its vertices ascending. A quad stands as the four triangles of its corners: in
// candidates a hex's quad is two triangles of the tet mesh, in a result it is one quad.
struct TaggedTriangle {
  std::array<std::int32_t, 3> key;
  std::int32_t tag;
};
void append_tagged(const std::vector<std::array<std::int32_t, 3>>& triangles, const std::vector<std::int32_t>& tags,
                   std::vector<TaggedTriangle>& all);
void append_tagged(const std::vector<std::array<std::int32_t, 4>>& quads, const std::vector<std::int32_t>& tags,
                   std::vector<TaggedTriangle>& all);

// Sets regions, surfaces and surface_facets of a scene that has its cells.
void find_groups(const formats::GroupNames& names, std::vector<TaggedTriangle> triangles, Scene& scene);

}  // namespace hexpipe::viewmesh
