#include "tools/tetmesh/geometry/box_tree.hpp"

#include <numeric>

#include "tools/tetmesh/geometry/triangle_slices.hpp"

namespace hexpipe::tetmesh::geometry {

double Box::entry(const Vec3& from, const Vec3& inverse) const {
  double in = 0, out = std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis) {
    // A ray in the plane of a side gives 0 times infinity. std::max and std::min ignore that in this order of
    // arguments.
    const double one = (low[axis] - from[axis]) * inverse[axis], other = (high[axis] - from[axis]) * inverse[axis];
    in = std::max(in, std::min(one, other));
    out = std::min(out, std::max(one, other));
  }
  return in <= out ? in : std::numeric_limits<double>::infinity();
}

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const double> values) : things_(boxes.size()) {
  std::iota(things_.begin(), things_.end(), 0);
  nodes_.reserve(boxes.size());
  if (!things_.empty()) build(boxes, values, things_);
}

// Splits the things into halves along the longest side of the box of their centres.
std::int32_t BoxTree::build(std::span<const Box> boxes, std::span<const double> values,
                            std::span<std::int32_t> things) {
  const auto number = static_cast<std::int32_t>(nodes_.size());
  Node node{boxes[things[0]], values[things[0]], 0, 0};
  const Vec3 first_centre = node.box.centre();
  Box centres{first_centre, first_centre};
  for (const std::int32_t i : things) {
    node.box.add(boxes[i]);
    node.value = std::min(node.value, values[i]);
    const Vec3 centre = boxes[i].centre();
    centres.add({centre, centre});
  }
  nodes_.push_back(node);
  if (things.size() <= most_in_leaf) {
    nodes_[number].count = static_cast<std::int32_t>(things.size());
    nodes_[number].first = static_cast<std::int32_t>(things.data() - things_.data());
    return number;
  }
  const int axis = centres.longest_axis();
  const std::size_t half = things.size() / 2;
  std::nth_element(things.begin(), things.begin() + static_cast<std::ptrdiff_t>(half), things.end(),
                   [&](std::int32_t a, std::int32_t b) {
                     const double at_a = boxes[a].centre()[axis], at_b = boxes[b].centre()[axis];
                     return at_a < at_b || (at_a == at_b && a < b);
                   });
  build(boxes, values, things.first(half));
  const std::int32_t second = build(boxes, values, things.subspan(half));
  nodes_[number].first = second;
  return number;
}

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const double> values, std::span<const std::int32_t> owners)
    : BoxTree(boxes, values) {
  for (std::int32_t& thing : things_) thing = owners[thing];
}

BoxTree tree_of_triangles(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  const double length = length_of_slices(points, triangles);
  std::vector<Box> boxes;
  std::vector<std::int32_t> owners;
  boxes.reserve(triangles.size());
  owners.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    TriangleSlices(points[a], points[b], points[c], length).for_each_box([&](const Box& box) {
      boxes.push_back(box);
      owners.push_back(static_cast<std::int32_t>(i));
    });
  }
  return {boxes, std::vector<double>(boxes.size(), 0.0), owners};
}

}  // namespace hexpipe::tetmesh::geometry
