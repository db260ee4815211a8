#pragma once
// Tags that the user asks for: of smooth pieces of the surface, and names.

#include <cstdint>
#include <span>
#include <string>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

inline constexpr double default_tag_angle = 40;

// Gives each piece of the surface within edges that turn by more than the angle (degrees), or that are curves, a tag of
// its own. Numbers go up from 1 in the order of the first triangles. Triangles whose tag has a name keep it, unless
// all have the same.
void tag_by_angle(Surface& surface, double angle);

struct TagName {
  bool of_region = false;
  std::int32_t tag = 0;
  std::string name;
};

// "3=inlet" for a surface, "region 1=steel" for a region. Throws UsageError for anything else.
TagName parse_tag_name(const std::string& text);

// Throws DataError where no triangle, or no region, has the tag.
void name_tags(Surface& surface, std::span<const TagName> names);

}  // namespace hexpipe::tetmesh::solid
