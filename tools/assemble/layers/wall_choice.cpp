#include "tools/assemble/layers/wall_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include "common/mesh/facet_key.hpp"
#include "common/run/command_line.hpp"
#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::assemble::layers {
namespace {

using formats::trimmed;

constexpr std::size_t most_listed = 12;  // names in a message
constexpr int most_layers = 100;
constexpr std::string_view everything = "all", in = " in ";

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

// Where the wall ends that the text begins with: at the comma, or the end, behind the first '=' with only a number
// between. Names may have commas.
std::size_t end_of_wall(std::string_view text) {
  for (std::size_t equals = text.find('='); equals != std::string_view::npos; equals = text.find('=', equals + 1)) {
    const std::size_t comma = std::min(text.find(',', equals), text.size());
    const std::string_view number = trimmed(text.substr(equals + 1, comma - equals - 1));
    double value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error == std::errc() && end == number.data() + number.size()) return comma;
  }
  return std::min(text.find(','), text.size());
}

using Tags = std::set<std::int32_t>;
using Names = std::map<std::int32_t, std::string>;

// A name comes before a number: a surface may be called "3".
Tags tags_named(std::string_view name, const Tags& all, const Names& names, std::string_view kind) {
  Tags named, numbered;
  for (const std::int32_t tag : all) {
    const auto known = names.find(tag);
    if (known != names.end() && known->second == name) named.insert(tag);
    if (name == std::to_string(tag) || name == fmt::format("{}_{}", kind, tag)) numbered.insert(tag);
  }
  return named.empty() ? numbered : named;
}

// "5 (floor)", or "5" if it has no name.
std::string title_of(std::int32_t tag, const Names& names) {
  const auto name = names.find(tag);
  return name == names.end() ? std::to_string(tag) : fmt::format("{} ({})", tag, name->second);
}

std::string list_of(const Tags& tags, const Names& names) {
  std::string list;
  std::size_t listed = 0;
  for (const std::int32_t tag : tags) {
    if (listed++ == most_listed) return list + fmt::format(" and {} more", tags.size() - most_listed);
    list += fmt::format("{}{}", list.empty() ? "" : ", ", title_of(tag, names));
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

// The regions and tags beside the facets of each tag.
struct Sides {
  std::map<std::int32_t, Tags> regions;  // by tag of the surface
  Tags outer;                            // tags of facets that have a tet on one side only

  explicit Sides(const TetMesh& mesh) {
    struct Beside {
      int tets = 0;
      std::array<std::int32_t, 2> regions{};
    };
    KeyMap<3, Beside> beside;
    beside.reserve(mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles) beside[key_of(triangle)] = {};
    for (std::size_t i = 0; i < mesh.tets.size(); ++i)
      for (const auto& facet : TetTopology::triangles) {
        const Tet& t = mesh.tets[i];
        const auto found = beside.find(key_of(Triangle{t[facet[0]], t[facet[1]], t[facet[2]]}));
        if (found == beside.end() || found->second.tets == 2) continue;
        Beside& here = found.value();
        here.regions[static_cast<std::size_t>(here.tets++)] = mesh.tet_tags[i];
      }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Beside& here = beside[key_of(mesh.triangles[i])];
      if (here.tets == 1) outer.insert(mesh.triangle_tags[i]);
      for (int side = 0; side < here.tets; ++side)
        regions[mesh.triangle_tags[i]].insert(here.regions[static_cast<std::size_t>(side)]);
    }
  }
};

// The walls that are asked for, one by one.
class WallChooser {
 public:
  WallChooser(const TetMesh& mesh, const TagNames& names, std::string_view source)
      : mesh_(mesh),
        names_(names),
        source_(source),
        surfaces_(mesh.triangle_tags.begin(), mesh.triangle_tags.end()),
        regions_(mesh.tet_tags.begin(), mesh.tet_tags.end()) {}

  void add(const AskedWall& wall);
  std::vector<WallGroup> take();

 private:
  struct Found {
    Tags surfaces, regions;  // no regions: on all sides
  };
  struct Group {
    int layers;
    std::string asked;  // by the first one that asked for it
    Tags regions;
  };

  Found find(std::string_view name);
  Found find_in_region(std::string_view surface, std::string_view region);
  void add(std::int32_t tag, const AskedWall& wall, const Tags& regions);
  void check_touching() const;
  std::string title(std::int32_t tag) const { return title_of(tag, names_.surfaces); }
  Sides& sides() {
    if (!sides_) sides_.emplace(mesh_);
    return *sides_;
  }
  [[noreturn]] void fail_surface(std::string_view name) const {
    fail(source_, "surface", name, surfaces_, names_.surfaces);
  }

  const TetMesh& mesh_;
  const TagNames& names_;
  std::string_view source_;
  const Tags surfaces_, regions_;
  std::optional<Sides> sides_;
  std::map<std::int32_t, Group> groups_;  // by tag
};

WallChooser::Found WallChooser::find_in_region(std::string_view surface, std::string_view region) {
  const Tags behind = tags_named(region, regions_, names_.regions, "region");
  if (behind.empty()) fail(source_, "region", region, regions_, names_.regions);
  const Tags tags = surface == everything ? surfaces_ : tags_named(surface, surfaces_, names_.surfaces, "surface");
  if (tags.empty()) fail_surface(surface);
  Found found{{}, behind};
  Tags bounded;
  for (const std::int32_t tag : tags) {
    const Tags& beside = sides().regions[tag];
    bounded.insert(beside.begin(), beside.end());
    if (std::ranges::any_of(behind, [&](std::int32_t r) { return beside.contains(r); })) found.surfaces.insert(tag);
  }
  if (found.surfaces.empty())
    throw DataError::at(source_, "--boundary-layers: expected surface '{}' to bound region '{}'; it bounds {}", surface,
                        region, bounded.empty() ? "none" : list_of(bounded, names_.regions));
  return found;
}

WallChooser::Found WallChooser::find(std::string_view name) {
  if (Tags tags = tags_named(name, surfaces_, names_.surfaces, "surface"); !tags.empty()) return {std::move(tags), {}};
  if (name == everything) return {sides().outer, {}};
  const std::size_t cut = name.rfind(in);
  if (cut == std::string_view::npos) fail_surface(name);
  return find_in_region(trimmed(name.substr(0, cut)), trimmed(name.substr(cut + in.size())));
}

void WallChooser::add(std::int32_t tag, const AskedWall& wall, const Tags& regions) {
  const auto [at, is_new] = groups_.try_emplace(tag, Group{wall.layers, wall.name, regions});
  Group& group = at->second;
  if (is_new) return;
  const bool both_sided = !group.regions.empty() && !regions.empty() && group.regions != regions;
  if (group.layers != wall.layers && both_sided)
    throw DataError::at(source_,
                        "--boundary-layers: expected as many layers on both sides of surface {}, found '{}={}' and "
                        "'{}={}'; '{}={}' puts layers on both",
                        title(tag), group.asked, group.layers, wall.name, wall.layers, tag, group.layers);
  if (group.layers != wall.layers)
    throw DataError::at(source_, "--boundary-layers: expected surface {} once, found it with {} and with {} layers",
                        title(tag), group.layers, wall.layers);
  if (regions.empty())
    group.regions.clear();
  else if (!group.regions.empty())
    group.regions.insert(regions.begin(), regions.end());
}

void WallChooser::add(const AskedWall& wall) {
  const Found found = find(wall.name);
  for (const std::int32_t tag : found.surfaces) add(tag, wall, found.regions);
}

// Walls that touch share the lines between them.
void WallChooser::check_touching() const {
  std::vector<const std::pair<const std::int32_t, Group>*> wall_at(mesh_.points.size(), nullptr);
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const auto wall = groups_.find(mesh_.triangle_tags[i]);
    if (wall == groups_.end()) continue;
    for (const Vertex v : mesh_.triangles[i]) {
      const auto* other = std::exchange(wall_at[static_cast<std::size_t>(v)], &*wall);
      if (other != nullptr && other->second.layers != wall->second.layers)
        throw DataError::at(
            source_,
            "--boundary-layers: expected as many layers on surfaces that touch, found {} on surface {} and {} on {}",
            other->second.layers, title(other->first), wall->second.layers, title(wall->first));
    }
  }
}

std::vector<WallGroup> WallChooser::take() {
  check_touching();
  std::vector<WallGroup> walls;
  for (const auto& [tag, group] : groups_)
    walls.push_back({tag, group.layers, {group.regions.begin(), group.regions.end()}});
  return walls;
}

}  // namespace

std::vector<AskedWall> parse_walls(std::string_view text) {
  std::vector<AskedWall> walls;
  while (true) {
    const std::size_t end = end_of_wall(text);
    walls.push_back(parse_wall(text.substr(0, end)));
    if (end == text.size()) return walls;
    text.remove_prefix(end + 1);
  }
}

std::vector<WallGroup> find_walls(std::span<const AskedWall> asked, const TetMesh& mesh, const TagNames& names,
                                  std::string_view source) {
  WallChooser finder(mesh, names, source);
  for (const AskedWall& wall : asked) finder.add(wall);
  return finder.take();
}

}  // namespace hexpipe::assemble::layers
