#include "formats/meshes/grouped_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <type_traits>
#include <utility>

#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"
#include "formats/meshes/facet_owners.hpp"
#include "formats/meshes/mesh_blocks.hpp"

namespace hexpipe::formats {
namespace {

// The names and numbers of groups, by tag.
struct Naming {
  GroupNaming surfaces, regions;
  std::map<std::int32_t, std::int32_t> surface_numbers, region_numbers;
};

// The number of the first tag of each name.
std::map<std::int32_t, std::int32_t> one_number_a_name(const GroupNaming& naming,
                                                       std::map<std::int32_t, std::int32_t> numbers) {
  std::map<std::string, std::int32_t> first;
  for (const auto& [tag, name] : naming.all()) numbers[tag] = first.try_emplace(name, numbers.at(tag)).first->second;
  return numbers;
}

Naming naming_of(const MixedMesh& mesh, const MeshWriting& writing, const GroupRules& rules) {
  std::vector<std::string> taken;
  for (const char* const name : rules.reserved)
    if (name != nullptr) taken.emplace_back(name);
  const GroupNaming surfaces(mesh, GroupKind::surface, writing, rules.names, taken);
  if (rules.apart)
    for (const std::string& name : surfaces.list()) taken.push_back(name);
  const GroupNaming regions(mesh, GroupKind::region, writing, rules.names, taken);
  const GroupNumbers numbers = group_numbers(mesh, rules.apart);
  return {surfaces, regions, one_number_a_name(surfaces, numbers.surfaces),
          one_number_a_name(regions, numbers.regions)};
}

// Collects elements of one kind into groups.
class Collector {
 public:
  Collector(std::uint8_t kind, const GroupNaming& names, const std::map<std::int32_t, std::int32_t>& numbers)
      : kind_(kind), names_(names), numbers_(numbers) {}

  template <class Element>
  ElementGroup& add(const Element& element, std::int32_t tag, std::int64_t place) {
    ElementGroup& group = groups_[numbers_.at(tag)];
    if (group.kind == 0) group.kind = kind_, group.number = numbers_.at(tag), group.name = names_.of(tag);
    group.corners.insert(group.corners.end(), element.begin(), element.end());
    group.places.push_back(place);
    return group;
  }

  void take(std::vector<ElementGroup>& groups) {
    for (auto& [number, group] : groups_) groups.push_back(std::move(group));
  }

 private:
  std::uint8_t kind_;
  const GroupNaming& names_;
  const std::map<std::int32_t, std::int32_t>& numbers_;
  std::map<std::int32_t, ElementGroup> groups_;
};

}  // namespace

GroupedMesh grouped(const MixedMesh& mesh, const MeshWriting& writing, const GroupRules& rules,
                    std::string_view output) {
  const Naming naming = naming_of(mesh, writing, rules);
  GroupedMesh result;
  result.points = mesh.points;
  result.second_order = mesh.second_order.has_value();
  result.full = mesh.second_order && mesh.second_order->full;
  const auto add_nodes = [&](ElementGroup& group, std::uint8_t vtk, std::size_t i) {
    if (!mesh.second_order) return;
    const auto nodes = mesh.second_order->of(vtk, i);
    group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
  };
  std::map<CellKind, std::int64_t> first_of_kind;
  std::int64_t place = 0;
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    if (names.dimension != 3) return;
    first_of_kind[static_cast<CellKind>(names.vtk)] = place;
    Collector groups(names.vtk, naming.regions, naming.region_numbers);
    for (std::size_t i = 0; i < block.size(); ++i)
      add_nodes(groups.add(block.cells[i], block.tags[i], place++), names.vtk, i);
    groups.take(result.cells);
  });
  const FacetOwners owners = find_facet_owners(mesh);
  place = 0;
  const auto add_facets = [&](const ElementNames& names, const auto& block, const std::vector<FacetOwner>& owner) {
    Collector groups(names.vtk, naming.surfaces, naming.surface_numbers);
    for (std::size_t i = 0; i < block.size(); ++i) {
      ElementGroup& group = groups.add(block.cells[i], block.tags[i], place++);
      add_nodes(group, names.vtk, i);
      const bool has_cell = owner[i].cell != no_index;
      if (!has_cell && rules.needs_sides)
        throw DataError::at(output, "cannot write {}s[{}]: {} surfaces consist of facets of cells, and it is none",
                            names.one, i, rules.names.format);
      group.sides.push_back(
          {has_cell ? first_of_kind[owner[i].kind] + owner[i].cell : no_index, owner[i].kind, owner[i].facet});
    }
    groups.take(result.facets);
  };
  add_facets(triangle_names, mesh.triangles, owners.triangles);
  add_facets(quad_names, mesh.quads, owners.quads);
  return result;
}

namespace {

std::string ending_of_kind(std::uint8_t kind) {
  return fmt::format("_{}", name_of(static_cast<CellKind>(kind)));
}

}  // namespace

void name_blocks_by_kind(GroupedMesh& mesh) {
  std::map<std::int32_t, int> kinds;
  std::set<std::string> taken;
  for (const ElementGroup& group : mesh.cells) {
    ++kinds[group.number];
    taken.insert(group.name);
  }
  for (ElementGroup& group : mesh.cells) {
    if (kinds[group.number] == 1) continue;
    const std::string base = group.name + ending_of_kind(group.kind);
    group.name = base;
    for (int number = 2; !taken.insert(group.name).second; ++number) group.name = fmt::format("{}_{}", base, number);
  }
}

void join_blocks_of_kinds(GroupedMesh& mesh) {
  // The kinds whose blocks have a name that ends in them, by the rest of the name.
  std::map<std::string, std::map<std::uint8_t, std::vector<ElementGroup*>>> by_base;
  for (ElementGroup& group : mesh.cells) {
    const std::string ending = ending_of_kind(group.kind);
    if (group.name.size() <= ending.size() || !group.name.ends_with(ending)) continue;
    by_base[group.name.substr(0, group.name.size() - ending.size())][group.kind].push_back(&group);
  }
  for (auto& [base, kinds] : by_base) {
    if (kinds.size() < 2) continue;
    std::int32_t number = std::numeric_limits<std::int32_t>::max();
    for (const auto& [kind, groups] : kinds)
      for (const ElementGroup* group : groups) number = std::min(number, group->number);
    for (const auto& [kind, groups] : kinds)
      for (ElementGroup* group : groups) group->number = number, group->name = base;
  }
}

namespace {

// The tags of groups that come from a file.
class Tags {
 public:
  Tags(const std::vector<ElementGroup>& groups, GroupKind kind) : kind_(kind) {
    for (const ElementGroup& group : groups)
      if (const auto tag = told_tag(group.name, kind))
        if (used_.insert(*tag).second) tags_[key_of(group)] = *tag;
    std::int32_t free_tag = 1;
    for (const ElementGroup& group : groups) {
      const auto [place, is_new] = tags_.try_emplace(key_of(group), group.number);
      if (!is_new || used_.insert(place->second).second) continue;
      while (!used_.insert(free_tag).second) ++free_tag;
      place->second = free_tag;
    }
  }

  std::int32_t of(const ElementGroup& group) const { return tags_.at(key_of(group)); }

  void add_names(const std::vector<ElementGroup>& groups, std::map<std::int32_t, std::string>& names) const {
    for (const ElementGroup& group : groups)
      if (!group.name.empty() && told_tag(group.name, kind_) != of(group)) names[of(group)] = group.name;
  }

 private:
  using Key = std::pair<std::string, std::int32_t>;
  // Groups of one name are one, whatever their numbers.
  static Key key_of(const ElementGroup& group) { return {group.name, group.name.empty() ? group.number : 0}; }

  GroupKind kind_;
  std::map<Key, std::int32_t> tags_;
  std::set<std::int32_t> used_;
};

// An element of a list of groups.
struct Place {
  std::int64_t place;
  std::size_t group, element;
};

// In the order in which the file numbers them.
std::vector<Place> places_of(const std::vector<ElementGroup>& groups) {
  std::vector<Place> places;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t i = 0; i < groups[g].size(); ++i)
      places.push_back(
          {groups[g].places.empty() ? static_cast<std::int64_t>(places.size()) : groups[g].places[i], g, i});
  std::ranges::stable_sort(places, {}, &Place::place);
  return places;
}

void add_elements(const std::vector<ElementGroup>& groups, const Tags& tags, int dimension, MixedMesh& mesh) {
  std::vector<std::int32_t> tag_of_group(groups.size());
  std::ranges::transform(groups, tag_of_group.begin(), [&](const ElementGroup& group) { return tags.of(group); });
  const std::vector<Place> places = places_of(groups);
  KeySet<3> triangles;
  KeySet<4> quads;
  const auto is_new = [&](const auto& facet) {
    if constexpr (std::tuple_size_v<std::remove_cvref_t<decltype(facet)>> == 3)
      return triangles.insert(key_of(facet)).second;
    else
      return quads.insert(key_of(facet)).second;
  };
  for_each_block(mesh, [&](const ElementNames& names, auto& block) {
    if (names.dimension != dimension) return;
    for (const Place& at : places) {
      const ElementGroup& group = groups[at.group];
      if (group.kind != names.vtk) continue;
      typename std::remove_cvref_t<decltype(block.cells)>::value_type cell;
      std::copy_n(group.corners.begin() + static_cast<std::ptrdiff_t>(at.element * cell.size()), cell.size(),
                  cell.begin());
      if constexpr (std::tuple_size_v<decltype(cell)> <= 4)
        if (names.dimension == 2 && !is_new(cell)) continue;
      block.cells.push_back(cell);
      block.tags.push_back(tag_of_group[at.group]);
    }
  });
}

}  // namespace

MixedMesh ungrouped(GroupedMesh mesh, GroupNames* names) {
  MixedMesh result;
  result.points = std::move(mesh.points);
  const Tags regions(mesh.cells, GroupKind::region), surfaces(mesh.facets, GroupKind::surface);
  add_elements(mesh.cells, regions, 3, result);
  add_elements(mesh.facets, surfaces, 2, result);
  if (names != nullptr) {
    regions.add_names(mesh.cells, names->regions);
    surfaces.add_names(mesh.facets, names->surfaces);
  }
  return result;
}

}  // namespace hexpipe::formats
