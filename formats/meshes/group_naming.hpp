#pragma once
// Names of groups as a format can hold them.

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/group_names.hpp"

namespace hexpipe::formats {

enum class GroupKind { surface, region };

// The name of a tag; without one, surface_3 or region_-1.
std::string group_name(const GroupNames& names, GroupKind kind, std::int32_t tag);

// The tag in such a name of an unnamed group, also with m for the minus sign: surface_3, region_m1.
std::optional<std::int32_t> told_tag(std::string_view name, GroupKind kind);

// The names that a format's readers accept.
struct NameRules {
  const char* format;       // for messages
  std::size_t longest;      // bytes
  std::string_view others;  // characters that are allowed beside letters, digits and _
  bool folds_case = false;  // inlet and INLET are one name
  bool begins_with_letter = false;
  bool ascii_only = true;
};

// The names of all tags of a kind, each changed as little as the rules require: characters that are not allowed become
// _, long names are cut, and if two names become the same, the later one gets _2. Tags with the same name keep the same
// name: they are one group. Each change is reported. `reserved` names are given to none.
class GroupNaming {
 public:
  GroupNaming(const MixedMesh& mesh, GroupKind kind, const MeshWriting& writing, const NameRules& rules,
              const std::vector<std::string>& reserved = {});

  const std::string& of(std::int32_t tag) const { return names_.at(tag); }
  // By ascending tag.
  const std::map<std::int32_t, std::string>& all() const { return names_; }
  // Each name once, in the order of their first tags.
  std::vector<std::string> list() const;

 private:
  std::map<std::int32_t, std::string> names_;
};

// The names of surfaces and regions, if one name must not stand for both: the surfaces' names come first.
struct GroupNamings {
  GroupNaming surfaces, regions;

  GroupNamings(const MixedMesh& mesh, const MeshWriting& writing, const NameRules& rules,
               std::vector<std::string> reserved = {});
};

// Positive numbers for the tags: the tag where it is positive, otherwise the least that no tag of the kind has.
struct GroupNumbers {
  std::map<std::int32_t, std::int32_t> surfaces, regions;
};
// `apart`: no number is one of a surface and one of a region. Then regions give way: theirs is mostly a single one, and
// boundary conditions are given to surfaces.
// Tags above `most` get another number, too.
GroupNumbers group_numbers(const MixedMesh& mesh, bool apart,
                           std::int32_t most = std::numeric_limits<std::int32_t>::max());

}  // namespace hexpipe::formats
