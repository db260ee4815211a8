#pragma once
// Things in a tree of boxes. It finds the thing with the least value, where values grow with the distance, the things
// near a box, and the pairs of things near each other.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

struct Box {
  Vec3 low, high;

  static Box around(std::span<const Vec3> points) {
    Box box{points.front(), points.front()};
    for (const Vec3& p : points) box.add({p, p});
    return box;
  }
  void add(const Box& other) {
    low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
    high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y), std::max(high.z, other.high.z)};
  }
  // Whether they have a point in common, if only on their sides.
  bool meets(const Box& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y &&
           low.z <= other.high.z && other.low.z <= high.z;
  }
  double diagonal() const { return norm(high - low); }
  Vec3 centre() const { return 0.5 * (low + high); }
  // The first of the axes along which it is longest.
  int longest_axis() const {
    const Vec3 extent = high - low;
    return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  }
  double distance(const Vec3& p) const {
    const auto outside = [](double x, double from, double to) { return std::max({from - x, x - to, 0.0}); };
    return norm(Vec3{outside(p.x, low.x, high.x), outside(p.y, low.y, high.y), outside(p.z, low.z, high.z)});
  }
  // Where a ray enters the box, in lengths of its direction; `inverse` holds the reciprocals of the direction's
  // components. Infinite where the ray misses the box.
  double entry(const Vec3& from, const Vec3& inverse) const {
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
};

class BoxTree {
 public:
  // The number of a thing is the number of its box. `values` has a lower bound for each thing on the value that least()
  // compares.
  BoxTree(std::span<const Box> boxes, std::span<const double> values);
  // A thing may have several boxes that cover it together: `owners` says to which thing each box belongs.
  BoxTree(std::span<const Box> boxes, std::span<const double> values, std::span<const std::int32_t> owners);

  // The least of value_of(thing) over the things, to 10^-9 of it, or `most` if no value is below that. A value must be
  // at least the thing's lower bound plus `slope` times the distance of p from the nearest of its boxes.
  template <class ValueOf>
  double least(const Vec3& p, double slope, double most, ValueOf&& value_of) const {
    return search(most, value_of, [&](const Node& node) { return node.value + slope * node.box.distance(p); });
  }

  // The least of length_to(thing) over the things whose boxes the ray meets, or `most` if no length is below that.
  template <class LengthTo>
  double first_hit(const Vec3& from, const Vec3& direction, double most, LengthTo&& length_to) const {
    const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
    return search(most, length_to, [&](const Node& node) { return node.box.entry(from, inverse); });
  }

  // Calls visit(thing) for the things in the leaves whose boxes meet this one: those that meet it, and others beside
  // them.
  template <class Visit>
  void for_each_near(const Box& box, Visit&& visit) const {
    std::array<std::int32_t, most_pending> stack;
    std::size_t depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const std::int32_t number = stack[--depth];
      const Node& node = nodes_[number];
      if (!node.box.meets(box)) continue;
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) visit(things_[i]);
      if (node.count > 0) continue;
      stack[depth++] = node.first;
      stack[depth++] = number + 1;
    }
  }

  // Things of two branches of the tree, or of one branch with each other.
  struct Meeting {
    std::int32_t one, other;  // nodes; the same one for a branch with itself
  };
  // Meetings that together have each pair of things near each other once, so that threads can share them out; there are
  // a few for each branch of up to `most` things.
  std::vector<Meeting> meetings(std::size_t most) const;
  // Calls visit(one, other) for the pairs of a meeting whose leaves have boxes that meet: pairs of things whose boxes
  // meet, and others beside them. Whoever asks for the neighbours of each thing goes down the tree once for each.
  template <class Visit>
  void for_each_near_pair(const Meeting& meeting, Visit&& visit) const {
    std::array<Meeting, 2 * most_pending> stack;
    std::size_t depth = 0;
    stack[depth++] = meeting;
    while (depth > 0) {
      const Meeting next = stack[--depth];
      if (is_between_leaves(next))
        visit_leaves(next, visit);
      else
        for_each_part(next, [&](const Meeting& part) { stack[depth++] = part; });
    }
  }

 private:
  struct Node {
    Box box;
    double value;
    // In a leaf: how many things it has, and where they begin. Otherwise: 0, and where its second child is; the first
    // child follows the node.
    std::int32_t count, first;
  };
  struct Pending {
    double bound;
    std::int32_t node;
  };
  // Keeps rounding from making the search look at every one of many things that are as good as the best.
  static constexpr double tolerance = 1 - 1e-9;
  static constexpr std::int32_t most_in_leaf = 2;
  static constexpr std::size_t most_pending = 128;  // twice the halvings of 2^31 things

  struct Centre {
    Vec3 at;
    std::int32_t thing;
  };
  // The centres of up to this many things are in the cache while their tree is built: 2 MB.
  static constexpr std::size_t most_beside = 1 << 16;

  std::int32_t build(std::span<const Box> boxes, std::span<const double> values, std::span<std::int32_t> things);
  std::int32_t build_beside(std::span<const Box> boxes, std::span<const double> values, std::span<Centre> centres,
                            std::int32_t first);
  void join_children(std::int32_t number, std::int32_t second);

  bool is_between_leaves(const Meeting& meeting) const {
    return nodes_[meeting.one].count > 0 && nodes_[meeting.other].count > 0;
  }
  template <class Visit>
  void visit_leaves(const Meeting& meeting, Visit&& visit) const {
    const Node &one = nodes_[meeting.one], &other = nodes_[meeting.other];
    for (std::int32_t i = one.first; i < one.first + one.count; ++i)
      for (std::int32_t j = meeting.one == meeting.other ? i + 1 : other.first; j < other.first + other.count; ++j)
        visit(things_[i], things_[j]);
  }
  // Splits the branches that are no leaves, and passes over parts whose boxes do not meet.
  template <class Take>
  void for_each_part(const Meeting& meeting, Take&& take) const {
    const auto [one, other] = meeting;
    const auto take_if_they_meet = [&](std::int32_t a, std::int32_t b) {
      if (nodes_[a].box.meets(nodes_[b].box)) take(Meeting{a, b});
    };
    const auto halves = [&](std::int32_t number) { return std::array{number + 1, nodes_[number].first}; };
    if (one == other) {
      const auto [first, second] = halves(one);
      take(Meeting{first, first});
      take(Meeting{second, second});
      take_if_they_meet(first, second);
    } else if (nodes_[one].count > 0) {
      for (const std::int32_t b : halves(other)) take_if_they_meet(one, b);
    } else if (nodes_[other].count > 0) {
      for (const std::int32_t a : halves(one)) take_if_they_meet(a, other);
    } else {
      for (const std::int32_t a : halves(one))
        for (const std::int32_t b : halves(other)) take_if_they_meet(a, b);
    }
  }

  template <class ValueOf, class Bound>
  double search(double best, ValueOf&& value_of, Bound&& bound) const {
    std::array<Pending, most_pending> stack;
    std::size_t depth = 0;
    if (!nodes_.empty()) stack[depth++] = {bound(nodes_[0]), 0};
    while (depth > 0) {
      const Pending next = stack[--depth];
      if (!(next.bound < tolerance * best)) continue;
      const Node& node = nodes_[next.node];
      if (node.count > 0) {
        for (std::int32_t i = node.first; i < node.first + node.count; ++i) best = std::min(best, value_of(things_[i]));
        continue;
      }
      Pending near{bound(nodes_[next.node + 1]), next.node + 1}, far{bound(nodes_[node.first]), node.first};
      if (far.bound < near.bound) std::swap(near, far);
      stack[depth++] = far;
      stack[depth++] = near;
    }
    return best;
  }

  std::vector<Node> nodes_;
  std::vector<std::int32_t> things_;  // leaf by leaf
};

}  // namespace hexpipe
