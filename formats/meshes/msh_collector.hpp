#pragma once
// Collects the content of a .msh file of either version, and makes a mesh of it.

#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/number_map.hpp"

namespace hexpipe::formats {

// The numbers of an element apart from its corners. Physical group 0: it is in no group.
struct MshElementNumbers {
  std::int64_t element = 0;
  std::int32_t physical = 0;
  std::int32_t elementary = 0;
};

// A tag cannot be the number of a group if it is not positive, or if a group of the other dimension has the number. The
// group that we write for it has the tag in its name: `region_-1`, `surface_0`. Older files have a blank for the line
// below; there only tags that are not positive count.
const char* msh_group_word(int dimension);
std::optional<std::int32_t> tag_in_group_name(std::string_view name, int dimension);

class MshCollector {
 public:
  void reserve_nodes(std::size_t count);
  void add_node(std::int64_t number, const Vec3& point);
  std::size_t node_count() const { return mesh_.points.size(); }
  // Call it after the last node. Returns a number that two nodes have, if any.
  std::optional<std::int64_t> number_nodes();
  // The vertex of a node; no_index: there is no such node.
  Vertex vertex(std::int64_t node) const { return nodes_.find(node); }

  // Calls visit(block, add) for the block of a Gmsh element type; add(corners, numbers) adds an element to it. False
  // when we have no such elements.
  template <class Visitor>
  bool with_block(int type, Visitor&& visit);

  void name_group(int dimension, std::int32_t number, std::string_view name);
  void add_quality(std::int64_t element, double quality) { quality_.emplace_back(element, quality); }

  MixedMesh take_mesh();
  // The names of tags that the mesh has, once it is taken, except those that only repeat the number.
  const GroupNames& names() const { return names_; }

 private:
  static constexpr std::size_t block_count = 6;

  void set_tags();
  bool has_groups(int dimension);
  void sort_elements();
  void drop_repeated_elements();
  void set_qualities();
  std::int32_t tag_of_group(int dimension, std::int32_t physical) const;
  void set_names(int dimension);

  MixedMesh mesh_;
  std::vector<std::int64_t> node_numbers_;
  NumberMap nodes_;
  std::vector<MshElementNumbers> numbers_[block_count];  // in the order of for_each_block
  std::map<std::pair<int, std::int32_t>, std::int32_t> tags_in_names_;
  std::set<std::pair<int, std::int32_t>> numbers_of_groups_;  // that have names
  std::map<std::pair<int, std::int32_t>, std::string> group_names_;
  GroupNames names_;
  std::vector<std::pair<std::int64_t, double>> quality_;
};

template <class Visitor>
bool MshCollector::with_block(int type, Visitor&& visit) {
  bool found = false;
  std::size_t index = 0;
  for_each_block(mesh_, [&](const ElementNames& names, auto& block) {
    auto& numbers = numbers_[index++];
    if (names.gmsh != type) return;
    found = true;
    visit(block, [&](const auto& corners, const MshElementNumbers& element) {
      block.cells.push_back(corners);
      numbers.push_back(element);
    });
  });
  return found;
}

}  // namespace hexpipe::formats
