#pragma once
// Tags that the user asks for, for smooth components of the surface, and names of tags.

#include <cstdint>
#include <span>
#include <string>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

// Gives each smooth component of the surface a tag of its own. Components end at edges that turn by more than the angle
// (degrees), and at curves. The numbers go up from 1 in the order of the components' first triangles. Triangles whose
// tag has a name keep the tag, unless all triangles have the same tag.
void tag_by_angle(Surface& surface, double angle);

struct TagName {
  bool of_region = false;
  std::int32_t tag = 0;
  std::string name;
};

// Reads "3=inlet" as the name of a surface and "region 1=steel" as that of a region. Throws UsageError for anything
// else.
TagName parse_tag_name(const std::string& text);

// Throws DataError if no triangle or no region has the tag.
void name_tags(Surface& surface, std::span<const TagName> names);

}  // namespace hexpipe::tetmesh::solid
