#pragma once
// Names of tags: of surfaces (groups of facets), regions (of cells) and curves. They stand in one member of a bundle,
// names.json, and pass through all stages.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace hexpipe::formats {

struct GroupNames {
  // By tag. A name is UTF-8 and not empty; several tags may have the same one.
  std::map<std::int32_t, std::string> surfaces, regions, curves;

  bool empty() const { return surfaces.empty() && regions.empty() && curves.empty(); }
  bool operator==(const GroupNames&) const = default;
};

inline constexpr std::string_view names_member = "names.json";

// A name cleaned up: blanks around it are removed, control characters become blanks, and bytes that are not UTF-8 are
// taken for Latin-1. It may become empty: then there is no name.
std::string clean_name(std::string_view bytes);

// Parses the text of names.json. Throws DataError that begins with `where` if it is not such a text.
GroupNames parse_group_names(const std::string& text, const std::string& where);
std::string text_of(const GroupNames& names);

}  // namespace hexpipe::formats
