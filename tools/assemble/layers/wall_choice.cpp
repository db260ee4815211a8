#include "tools/assemble/layers/wall_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include "common/mesh/facet_key.hpp"
#include "common/run/command_line.hpp"
#include "common/run/error.hpp"

namespace hexpipe::assemble::layers {
namespace {

constexpr std::size_t most_listed = 12;  // names in a message
constexpr int most_layers = 100;
constexpr std::string_view everything = "all", in = " in ";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

AskedWall parse_wall(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  const std::string_view name = trimmed(text.substr(0, std::min(equals, text.size())));
  if (equals == std::string_view::npos || name.empty())
    throw UsageError(
        fmt::format("--boundary-layers: expected a surface and its number of layers, as 'wall=5', found '{}'", text));
  const std::string_view number = trimmed(text.substr(equals + 1));
  int layers = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), layers);
  if (error != std::errc() || end != number.data() + number.size() || layers < 1 || layers > most_layers)
    throw UsageError(
        fmt::format("--boundary-layers: expected 1 to {} layers on '{}', found '{}'", most_layers, name, number));
  return {std::string(name), layers};
}

using Tags = std::set<std::int32_t>;
using Names = std::map<std::int32_t, std::string>;

Tags tags_named(std::string_view name, const Tags& all, const Names& names, std::string_view kind) {
  Tags found;
  for (const std::int32_t tag : all) {
    const auto known = names.find(tag);
    const bool is_named = known != names.end() && known->second == name;
    if (is_named || name == std::to_string(tag) || name == fmt::format("{}_{}", kind, tag)) found.insert(tag);
  }
  return found;
}

std::string list_of(const Tags& tags, const Names& names) {
  std::string list;
  std::size_t listed = 0;
  for (const std::int32_t tag : tags) {
    if (listed++ == most_listed) return list + fmt::format(" and {} more", tags.size() - most_listed);
    const auto name = names.find(tag);
    list += fmt::format("{}{}", list.empty() ? "" : ", ", tag);
    if (name != names.end()) list += fmt::format(" ({})", name->second);
  }
  return list;
}

[[noreturn]] void fail(std::string_view source, std::string_view what, std::string_view name, const Tags& all,
                       const Names& names) {
  std::vector<std::string> known;
  for (const auto& [tag, title] : names)
    if (all.contains(tag)) known.push_back(title);
  const std::string near = near_option(name, known);
  throw DataError::at(source, "--boundary-layers: expected a {} by its name or number, found '{}'{}; there are {}",
                      what, name, near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near), list_of(all, names));
}

// Tags of facets that have a tet on one side only.
Tags outer_tags(const TetMesh& mesh) {
  KeyMap<3, int> uses;
  uses.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) uses[key_of(triangle)] = 0;
  for (const Tet& t : mesh.tets)
    for (const auto& facet : TetTopology::triangles)
      if (const auto found = uses.find(key_of(Triangle{t[facet[0]], t[facet[1]], t[facet[2]]})); found != uses.end())
        ++found.value();
  Tags tags;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (uses[key_of(mesh.triangles[i])] == 1) tags.insert(mesh.triangle_tags[i]);
  return tags;
}

// Walls that touch share the lines between them.
void check_touching(std::span<const WallGroup> walls, const TetMesh& mesh, std::string_view source) {
  std::vector<const WallGroup*> wall_at(mesh.points.size(), nullptr);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto wall = std::ranges::find(walls, mesh.triangle_tags[i], &WallGroup::tag);
    if (wall == walls.end()) continue;
    for (const Vertex v : mesh.triangles[i]) {
      if (wall_at[v] != nullptr && wall_at[v]->layers != wall->layers)
        throw DataError::at(
            source,
            "--boundary-layers: expected as many layers on surfaces that touch, found {} on surface {} and {} on {}",
            wall_at[v]->layers, wall_at[v]->tag, wall->layers, wall->tag);
      wall_at[v] = &*wall;
    }
  }
}

}  // namespace

std::vector<AskedWall> parse_walls(std::string_view text) {
  std::vector<AskedWall> walls;
  while (true) {
    const std::size_t comma = text.find(',');
    walls.push_back(parse_wall(text.substr(0, comma)));
    if (comma == std::string_view::npos) return walls;
    text.remove_prefix(comma + 1);
  }
}

std::vector<WallGroup> find_walls(std::span<const AskedWall> asked, const TetMesh& mesh, const TagNames& names,
                                  std::string_view source) {
  const Tags surfaces(mesh.triangle_tags.begin(), mesh.triangle_tags.end());
  const Tags regions(mesh.tet_tags.begin(), mesh.tet_tags.end());
  std::vector<WallGroup> walls;
  for (const AskedWall& wall : asked) {
    Tags tags = tags_named(wall.name, surfaces, names.surfaces, "surface");
    std::optional<std::int32_t> region;
    const std::size_t cut = wall.name.rfind(in);
    if (tags.empty() && cut != std::string::npos) {
      const std::string_view surface = trimmed(std::string_view(wall.name).substr(0, cut));
      const std::string_view side = trimmed(std::string_view(wall.name).substr(cut + in.size()));
      const Tags sides = tags_named(side, regions, names.regions, "region");
      if (sides.size() != 1) fail(source, "region", side, regions, names.regions);
      region = *sides.begin();
      tags = surface == everything ? surfaces : tags_named(surface, surfaces, names.surfaces, "surface");
      if (tags.empty()) fail(source, "surface", surface, surfaces, names.surfaces);
    }
    if (tags.empty() && wall.name == everything) tags = outer_tags(mesh);
    if (tags.empty()) fail(source, "surface", wall.name, surfaces, names.surfaces);
    for (const std::int32_t tag : tags) {
      const auto other = std::ranges::find(walls, tag, &WallGroup::tag);
      if (other == walls.end())
        walls.push_back({tag, wall.layers, region});
      else if (other->layers != wall.layers || other->region != region)
        throw DataError::at(source, "--boundary-layers: expected surface {} once, found it with {} and with {} layers",
                            tag, other->layers, wall.layers);
    }
  }
  check_touching(walls, mesh, source);
  return walls;
}

}  // namespace hexpipe::assemble::layers
