#include "common/mesh/box_tree.hpp"

#include <numeric>

namespace hexpipe {

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const double> values) : things_(boxes.size()) {
  std::iota(things_.begin(), things_.end(), 0);
  nodes_.reserve(boxes.size());
  if (!things_.empty()) build(boxes, values, things_);
}

// Splits the things into halves along the longest side of the box of their centres.
std::int32_t BoxTree::build(std::span<const Box> boxes, std::span<const double> values,
                            std::span<std::int32_t> things) {
  if (things.size() <= most_beside) {
    std::vector<Centre> centres;
    centres.reserve(things.size());
    for (const std::int32_t i : things) centres.push_back({boxes[i].centre(), i});
    return build_beside(boxes, values, centres, static_cast<std::int32_t>(things.data() - things_.data()));
  }
  const Vec3 first_centre = boxes[things[0]].centre();
  Box centres{first_centre, first_centre};
  for (const std::int32_t i : things) {
    const Vec3 centre = boxes[i].centre();
    centres.add({centre, centre});
  }
  const int axis = centres.longest_axis();
  const std::size_t half = things.size() / 2;
  std::nth_element(things.begin(), things.begin() + static_cast<std::ptrdiff_t>(half), things.end(),
                   [&](std::int32_t a, std::int32_t b) {
                     const double at_a = boxes[a].centre()[axis], at_b = boxes[b].centre()[axis];
                     return at_a < at_b || (at_a == at_b && a < b);
                   });
  const auto number = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  build(boxes, values, things.first(half));
  join_children(number, build(boxes, values, things.subspan(half)));
  return number;
}

// The same, with the centres side by side in the cache. They stand for the things from `first` on.
std::int32_t BoxTree::build_beside(std::span<const Box> boxes, std::span<const double> values,
                                   std::span<Centre> centres, std::int32_t first) {
  const auto number = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  if (centres.size() <= most_in_leaf) {
    Node& leaf = nodes_[number];
    leaf = {boxes[centres[0].thing], values[centres[0].thing], static_cast<std::int32_t>(centres.size()), first};
    for (std::size_t i = 0; i < centres.size(); ++i) {
      const std::int32_t thing = centres[i].thing;
      leaf.box.add(boxes[thing]);
      leaf.value = std::min(leaf.value, values[thing]);
      things_[first + static_cast<std::int32_t>(i)] = thing;
    }
    return number;
  }
  Box around{centres[0].at, centres[0].at};
  for (const Centre& centre : centres) around.add({centre.at, centre.at});
  const int axis = around.longest_axis();
  const std::size_t half = centres.size() / 2;
  std::nth_element(centres.begin(), centres.begin() + static_cast<std::ptrdiff_t>(half), centres.end(),
                   [&](const Centre& a, const Centre& b) {
                     return a.at[axis] < b.at[axis] || (a.at[axis] == b.at[axis] && a.thing < b.thing);
                   });
  build_beside(boxes, values, centres.first(half), first);
  join_children(number, build_beside(boxes, values, centres.subspan(half), first + static_cast<std::int32_t>(half)));
  return number;
}

// The first child follows the node.
void BoxTree::join_children(std::int32_t number, std::int32_t second) {
  const Node& one = nodes_[number + 1];
  Node node{one.box, one.value, 0, second};
  node.box.add(nodes_[second].box);
  node.value = std::min(node.value, nodes_[second].value);
  nodes_[number] = node;
}

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const double> values, std::span<const std::int32_t> owners)
    : BoxTree(boxes, values) {
  for (std::int32_t& thing : things_) thing = owners[thing];
}

}  // namespace hexpipe
