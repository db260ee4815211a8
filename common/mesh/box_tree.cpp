#include "common/mesh/box_tree.hpp"

#include <numeric>

namespace hexpipe {

namespace {

// Puts the things whose centres are lower along the longest side of the box around all centres into the first half. The
// number decides between equal centres. Returns how many they are.
template <class Thing, class CentreOf, class NumberOf>
std::size_t halve(std::span<Thing> things, CentreOf&& centre_of, NumberOf&& number_of) {
  Box around{centre_of(things[0]), centre_of(things[0])};
  for (const Thing& thing : things) around.add({centre_of(thing), centre_of(thing)});
  const std::size_t half = things.size() / 2;
  // A comparison need not ask which axis it is.
  const auto halve_along = [&]<double Vec3::*axis>() {
    std::nth_element(things.begin(), things.begin() + static_cast<std::ptrdiff_t>(half), things.end(),
                     [&](const Thing& a, const Thing& b) {
                       const double at_a = centre_of(a).*axis, at_b = centre_of(b).*axis;
                       return at_a < at_b || (at_a == at_b && number_of(a) < number_of(b));
                     });
  };
  switch (around.longest_axis()) {
    case 0:
      halve_along.template operator()<&Vec3::x>();
      break;
    case 1:
      halve_along.template operator()<&Vec3::y>();
      break;
    default:
      halve_along.template operator()<&Vec3::z>();
  }
  return half;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const double> values) : things_(boxes.size()) {
  std::iota(things_.begin(), things_.end(), 0);
  nodes_.reserve(boxes.size());
  if (!things_.empty()) build(boxes, values, things_);
}

std::int32_t BoxTree::build(std::span<const Box> boxes, std::span<const double> values,
                            std::span<std::int32_t> things) {
  if (things.size() <= most_beside) {
    std::vector<Centre> centres;
    centres.reserve(things.size());
    for (const std::int32_t i : things) centres.push_back({boxes[i].centre(), i});
    return build_beside(boxes, values, centres, static_cast<std::int32_t>(things.data() - things_.data()));
  }
  const std::size_t half = halve(
      things, [&](std::int32_t i) { return boxes[i].centre(); }, [](std::int32_t i) { return i; });
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
  const std::size_t half = halve(
      centres, [](const Centre& c) -> const Vec3& { return c.at; }, [](const Centre& c) { return c.thing; });
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

std::vector<BoxTree::Meeting> BoxTree::meetings(std::size_t most) const {
  if (things_.empty()) return {};
  // All meetings of one round have branches of one depth, up to a thing more or less.
  std::vector<Meeting> round{{0, 0}}, parts, done;
  for (std::size_t things = things_.size(); things > most && !round.empty(); things = (things + 1) / 2) {
    parts.clear();
    for (const Meeting& meeting : round)
      if (is_between_leaves(meeting))
        done.push_back(meeting);
      else
        for_each_part(meeting, [&](const Meeting& part) { parts.push_back(part); });
    std::swap(round, parts);
  }
  done.insert(done.end(), round.begin(), round.end());
  return done;
}

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const double> values, std::span<const std::int32_t> owners)
    : BoxTree(boxes, values) {
  for (std::int32_t& thing : things_) thing = owners[thing];
}

}  // namespace hexpipe
