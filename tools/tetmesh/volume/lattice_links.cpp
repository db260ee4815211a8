#include "tools/tetmesh/volume/lattice_links.hpp"

#include <algorithm>
#include <cmath>

#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// Which axis of the other frame is the nearest, and whether it points the same way.
struct AxisMatch {
  std::array<std::uint8_t, 3> axis;
  std::array<bool, 3> flipped;
  double quality;  // mean cosine
};

AxisMatch match(const fields::Frame& from, const fields::Frame& to) {
  static constexpr std::array<std::array<std::uint8_t, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  std::array<std::array<double, 3>, 3> cosines;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) cosines[i][j] = dot(from[i], to[j]);
  double best = -1;
  AxisMatch result{};
  for (const auto& order : orders) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::abs(cosines[i][order[i]]);
    if (sum <= best) continue;
    best = sum;
    result.axis = order;
  }
  for (std::size_t i = 0; i < 3; ++i) result.flipped[i] = cosines[i][result.axis[i]] < 0;
  result.quality = best / 3;
  return result;
}

}  // namespace

LatticeLinks::LatticeLinks(const FieldNodes& nodes, const std::vector<fields::Frame>& frames)
    : nodes_(nodes), links_(nodes.links.size()) {
  parallel_for(static_cast<std::int64_t>(nodes.size()), 256, [&](std::int64_t i) {
    for (std::int64_t l = nodes.offsets[i]; l < nodes.offsets[i + 1]; ++l)
      links_[l] = make(frames, static_cast<std::size_t>(i), nodes.links[l]);
  });
}

LatticeLink LatticeLinks::make(const std::vector<fields::Frame>& frames, std::size_t i, const FieldLink& link) const {
  const auto j = static_cast<std::size_t>(link.node);
  const AxisMatch matched = match(frames[i], frames[j]);
  LatticeLink made{.axis = matched.axis, .flipped = matched.flipped, .neighbour = link.node};
  made.weight = static_cast<double>(link.weight) * std::max(0.0, 4 * matched.quality - 3);
  const Vec3 back = (2 / (nodes_.sizes[i] + nodes_.sizes[j])) * (nodes_.points[i] - nodes_.points[j]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& there = frames[j][made.axis[k]];
    const Vec3 mean = 0.5 * (frames[i][k] + (made.flipped[k] ? -there : there));
    made.distance[k] = dot(mean, back);
  }
  return made;
}

std::int64_t LatticeLinks::between(std::int32_t from, std::int32_t to) const {
  const auto links = nodes_.links_of(static_cast<std::size_t>(from));
  const auto found = std::ranges::lower_bound(links, to, {}, &FieldLink::node);
  return found != links.end() && found->node == to ? nodes_.offsets[from] + (found - links.begin()) : -1;
}

bool LatticeLinks::comes_back(const LinkTriangle& triangle, std::size_t axis) const {
  const LatticeLink &to_second = links_[triangle.to_second], &to_third = links_[triangle.to_third],
                    &onward = links_[triangle.onward];
  if (std::min({to_second.weight, onward.weight, to_third.weight}) <= 0) return false;
  const std::size_t there = to_second.axis[axis];
  return onward.axis[there] == to_third.axis[axis] &&
         (to_second.flipped[axis] != onward.flipped[there]) == to_third.flipped[axis];
}

bool LatticeLinks::is_regular(const LinkTriangle& triangle) const {
  return comes_back(triangle, 0) && comes_back(triangle, 1) && comes_back(triangle, 2);
}

}  // namespace hexpipe::tetmesh::volume
