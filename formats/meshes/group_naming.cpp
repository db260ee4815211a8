#include "formats/meshes/group_naming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>
#include <system_error>
#include <utility>

#include "formats/meshes/mesh_blocks.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

bool is_allowed(char c, const NameRules& rules) {
  if (is_letter(c) || is_digit(c) || c == '_') return true;
  if ((static_cast<unsigned char>(c) & 0x80) != 0) return !rules.ascii_only;
  return rules.others.find(c) != std::string_view::npos;
}

// Not in the middle of a character of UTF-8.
void cut(std::string& name, std::size_t longest) {
  if (name.size() <= longest) return;
  while (longest > 0 && (static_cast<unsigned char>(name[longest]) & 0xc0) == 0x80) --longest;
  name.resize(longest);
}

std::string changed(std::string name, const NameRules& rules) {
  for (char& c : name)
    if (!is_allowed(c, rules)) c = '_';
  if (rules.begins_with_letter && !is_letter(name.front())) name.insert(0, "g_");
  cut(name, rules.longest);
  return name;
}

// A name as readers compare it.
std::string compared(std::string name, const NameRules& rules) {
  if (rules.folds_case)
    for (char& c : name)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return name;
}

std::string numbered(std::string name, int number, const NameRules& rules) {
  const std::string ending = fmt::format("_{}", number);
  cut(name, rules.longest - ending.size());
  return name + ending;
}

std::set<std::int32_t> tags_of(const MixedMesh& mesh, GroupKind kind) {
  std::set<std::int32_t> tags;
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    if ((names.dimension == 3) != (kind == GroupKind::region)) return;
    // Neighbours in a block mostly have one tag, which need not be looked up again.
    for (std::size_t i = 0; i < block.tags.size(); ++i)
      if (i == 0 || block.tags[i] != block.tags[i - 1]) tags.insert(block.tags[i]);
  });
  return tags;
}

}  // namespace

std::string group_name(const GroupNames& names, GroupKind kind, std::int32_t tag) {
  const auto& of_kind = kind == GroupKind::surface ? names.surfaces : names.regions;
  const auto found = of_kind.find(tag);
  if (found != of_kind.end() && !found->second.empty()) return found->second;
  return fmt::format("{}_{}", kind == GroupKind::surface ? "surface" : "region", tag);
}

std::optional<std::int32_t> told_tag(std::string_view name, GroupKind kind) {
  const std::string_view word = kind == GroupKind::surface ? "surface_" : "region_";
  if (!name.starts_with(word)) return std::nullopt;
  name.remove_prefix(word.size());
  const bool is_negative = name.starts_with('m') || name.starts_with('-');
  if (is_negative) name.remove_prefix(1);
  std::uint32_t size = 0;
  const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), size);
  if (error != std::errc{} || stop != name.data() + name.size()) return std::nullopt;
  const std::int64_t tag = is_negative ? -std::int64_t{size} : std::int64_t{size};
  if (tag < std::numeric_limits<std::int32_t>::min() || tag > std::numeric_limits<std::int32_t>::max())
    return std::nullopt;
  return static_cast<std::int32_t>(tag);
}

GroupNaming::GroupNaming(const MixedMesh& mesh, GroupKind kind, const MeshWriting& writing, const NameRules& rules,
                         const std::vector<std::string>& reserved) {
  std::map<std::string, std::string> by_original;
  std::set<std::string> taken;
  for (const std::string& name : reserved) taken.insert(compared(name, rules));
  for (const std::int32_t tag : tags_of(mesh, kind)) {
    const std::string original = group_name(writing.names, kind, tag);
    auto [place, is_new] = by_original.try_emplace(original);
    if (is_new) {
      std::string name = original;
      // A minus sign is the only thing that the name of an unnamed group may have too much.
      const bool is_unnamed = original == group_name({}, kind, tag);
      if (is_unnamed && tag < 0 && !is_allowed('-', rules)) *std::ranges::find(name, '-') = 'm';
      const std::string base = changed(std::move(name), rules);
      name = base;
      for (int number = 2; !taken.insert(compared(name, rules)).second; ++number) name = numbered(base, number, rules);
      if (name != original && !is_unnamed)
        writing.say(fmt::format("{} '{}' is written as {}: {} allows no such name, or another has it",
                                kind == GroupKind::surface ? "surface" : "region", original, name, rules.format));
      place->second = std::move(name);
    }
    names_[tag] = place->second;
  }
}

std::vector<std::string> GroupNaming::list() const {
  std::vector<std::string> list;
  std::set<std::string> seen;
  for (const auto& [tag, name] : names_)
    if (seen.insert(name).second) list.push_back(name);
  return list;
}

namespace {

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

GroupNamings::GroupNamings(const MixedMesh& mesh, const MeshWriting& writing, const NameRules& rules,
                           std::vector<std::string> reserved)
    : surfaces(mesh, GroupKind::surface, writing, rules, reserved),
      regions(mesh, GroupKind::region, writing, rules, joined(std::move(reserved), surfaces.list())) {}

namespace {

// `taken`: numbers that none of these tags may have.
std::map<std::int32_t, std::int32_t> number_tags(const std::set<std::int32_t>& tags, std::set<std::int32_t> taken,
                                                 std::int32_t most) {
  std::map<std::int32_t, std::int32_t> numbers;
  const auto keeps = [&](std::int32_t tag) { return tag > 0 && tag <= most && !taken.contains(tag); };
  for (const std::int32_t tag : tags)
    if (keeps(tag)) numbers[tag] = tag;
  taken.insert(tags.begin(), tags.end());
  std::int32_t free_number = 1;
  for (const std::int32_t tag : tags) {
    if (numbers.contains(tag)) continue;
    while (taken.contains(free_number)) ++free_number;
    numbers[tag] = free_number++;
  }
  return numbers;
}

}  // namespace

GroupNumbers group_numbers(const MixedMesh& mesh, bool apart, std::int32_t most) {
  GroupNumbers numbers{number_tags(tags_of(mesh, GroupKind::surface), {}, most), {}};
  std::set<std::int32_t> taken;
  if (apart)
    for (const auto& [tag, number] : numbers.surfaces) taken.insert(number);
  numbers.regions = number_tags(tags_of(mesh, GroupKind::region), std::move(taken), most);
  return numbers;
}

}  // namespace hexpipe::formats
