#include "formats/meshes/msh_collector.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>

#include "common/mesh/reorder.hpp"

namespace hexpipe::formats {
namespace {

// True when elements of one entity name different groups.
bool has_entity_in_two_groups(const std::vector<MshElementNumbers>& numbers) {
  std::map<std::int32_t, std::int32_t> group_of_entity;
  std::int32_t last_entity = 0, last_group = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto& [element, group, entity] = numbers[i];
    if (i > 0 && entity == last_entity && group == last_group) continue;
    if (group_of_entity.emplace(entity, group).first->second != group) return true;
    last_entity = entity;
    last_group = group;
  }
  return false;
}

// For each element, whether an earlier one has the same corners and entity.
template <class Cell>
std::vector<bool> find_repeated(const std::vector<Cell>& cells, const std::vector<MshElementNumbers>& numbers) {
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) { return std::pair(cells[i], numbers[i].elementary); };
  std::ranges::stable_sort(order, {}, key);
  std::vector<bool> repeated(cells.size());
  for (std::size_t k = 1; k < order.size(); ++k) repeated[order[k]] = key(order[k]) == key(order[k - 1]);
  return repeated;
}

template <class T>
void erase_marked(std::vector<T>& items, const std::vector<bool>& marked) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!marked[i]) items[kept++] = items[i];
  items.resize(kept);
}

}  // namespace

namespace {

// The name that we and others write for a tag without one: region 3, region_3.
bool is_default_name(std::string_view name, std::int32_t number, int dimension) {
  const std::string_view word = msh_group_word(dimension);
  return name.starts_with(word) && name.size() > word.size() &&
         (name[word.size()] == ' ' || name[word.size()] == '_') &&
         name.substr(word.size() + 1) == std::to_string(number);
}

}  // namespace

const char* msh_group_word(int dimension) {
  return dimension == 3 ? "region" : "surface";
}

std::optional<std::int32_t> tag_in_group_name(std::string_view name, int dimension) {
  const std::string_view word = msh_group_word(dimension);
  if (!name.starts_with(word) || name.size() <= word.size()) return std::nullopt;
  const char separator = name[word.size()];
  if (separator != ' ' && separator != '_') return std::nullopt;
  const char* const end = name.data() + name.size();
  std::int32_t tag = 0;
  const auto [stop, error] = std::from_chars(name.data() + word.size() + 1, end, tag);
  if (error != std::errc{} || stop != end || (tag > 0 && separator == ' ')) return std::nullopt;
  return tag;
}

void MshCollector::reserve_nodes(std::size_t count) {
  mesh_.points.reserve(count);
  node_numbers_.reserve(count);
}

void MshCollector::add_node(std::int64_t number, const Vec3& point) {
  mesh_.points.push_back(point);
  node_numbers_.push_back(number);
}

std::optional<std::int64_t> MshCollector::number_nodes() {
  nodes_ = NumberMap(node_numbers_);
  node_numbers_ = {};
  return nodes_.repeated();
}

void MshCollector::name_group(int dimension, std::int32_t number, std::string_view name) {
  numbers_of_groups_.insert({dimension, number});
  if (const auto tag = tag_in_group_name(name, dimension))
    tags_in_names_[{dimension, number}] = *tag;
  else if (std::string text = clean_name(name); !text.empty() && !is_default_name(text, number, dimension))
    group_names_[{dimension, number}] = std::move(text);
}

MixedMesh MshCollector::take_mesh() {
  sort_elements();
  drop_repeated_elements();
  set_tags();
  set_qualities();
  return std::move(mesh_);
}

void MshCollector::sort_elements() {
  std::size_t index = 0;
  for_each_block(mesh_, [&](const ElementNames&, auto& block) {
    auto& numbers = numbers_[index++];
    if (std::ranges::is_sorted(numbers, {}, &MshElementNumbers::element)) return;
    std::vector<std::size_t> order(numbers.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return numbers[i].element; });
    reorder(block.cells, order);
    reorder(numbers, order);
  });
}

// Gmsh writes an element of version 2 once for each group that its entity is in; the first counts.
void MshCollector::drop_repeated_elements() {
  std::size_t index = 0;
  for_each_block(mesh_, [&](const ElementNames&, auto& block) {
    auto& numbers = numbers_[index++];
    if (!has_entity_in_two_groups(numbers)) return;
    const std::vector<bool> repeated = find_repeated(block.cells, numbers);
    erase_marked(block.cells, repeated);
    erase_marked(numbers, repeated);
  });
}

void MshCollector::set_tags() {
  for (const int dimension : {2, 3}) {
    const bool from_groups = has_groups(dimension);
    std::size_t index = 0;
    for_each_block(mesh_, [&](const ElementNames& names, auto& block) {
      const auto& numbers = numbers_[index++];
      if (names.dimension != dimension) return;
      block.tags.reserve(numbers.size());
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        block.tags.push_back(from_groups ? tag_of_group(dimension, numbers[i].physical) : numbers[i].elementary);
        // A facet's group may hold it turned round; a cell has no other side.
        if (dimension == 2 && numbers[i].physical < 0) std::reverse(block.cells[i].begin() + 1, block.cells[i].end());
      }
    });
    if (from_groups) set_names(dimension);
  }
}

bool MshCollector::has_groups(int dimension) {
  bool found = false;
  std::size_t index = 0;
  for_each_block(mesh_, [&](const ElementNames& names, const auto&) {
    const auto& numbers = numbers_[index++];
    if (names.dimension == dimension && !found)
      found = std::ranges::any_of(numbers, [](const auto& element) { return element.physical != 0; });
  });
  return found;
}

void MshCollector::set_names(int dimension) {
  for (const auto& [group, name] : group_names_) {
    if (group.first != dimension) continue;
    const std::int32_t tag = tag_of_group(dimension, group.second);
    bool is_used = false;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      if (names.dimension == dimension && !is_used) is_used = std::ranges::find(block.tags, tag) != block.tags.end();
    });
    if (is_used) (dimension == 3 ? names_.regions : names_.surfaces)[tag] = name;
  }
}

// The number of a group that holds an element turned round is negative.
std::int32_t MshCollector::tag_of_group(int dimension, std::int32_t physical) const {
  const std::int32_t group =
      physical < 0 && physical != std::numeric_limits<std::int32_t>::min() ? -physical : physical;
  if (tags_in_names_.empty()) return group;
  const auto named = tags_in_names_.find({dimension, group});
  if (named == tags_in_names_.end()) return group;
  // A group of another program may have the number that this name tells.
  return numbers_of_groups_.contains({dimension, named->second}) ? group : named->second;
}

void MshCollector::set_qualities() {
  if (quality_.empty()) return;
  if (!std::ranges::is_sorted(quality_, {}, &std::pair<std::int64_t, double>::first))
    std::ranges::stable_sort(quality_, {}, &std::pair<std::int64_t, double>::first);
  std::size_t index = 0;
  for_each_block(mesh_, [&](const ElementNames& names, auto& block) {
    const auto& numbers = numbers_[index++];
    if (names.dimension != 3) return;
    block.quality.reserve(numbers.size());
    for (const MshElementNumbers& element : numbers) {
      const auto found =
          std::ranges::lower_bound(quality_, element.element, {}, &std::pair<std::int64_t, double>::first);
      if (found == quality_.end() || found->first != element.element) break;
      block.quality.push_back(found->second);
    }
    if (block.quality.size() != block.size()) block.quality.clear();
  });
}

}  // namespace hexpipe::formats
