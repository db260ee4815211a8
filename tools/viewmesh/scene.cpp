#include "tools/viewmesh/scene.hpp"

#include <algorithm>
#include <numeric>

namespace hexpipe::viewmesh {

int Scene::kind_index(std::int32_t cell) const {
  return static_cast<int>(std::upper_bound(kind_begin.begin(), kind_begin.end() - 1, cell) - kind_begin.begin()) - 1;
}

std::span<const std::int32_t> Scene::corners_of(std::int32_t cell) const {
  const int k = kind_index(cell);
  const std::size_t count = corner_count(scene_kinds[k]);
  return std::span(corners[k]).subspan(count * (cell - kind_begin[k]), count);
}

Vec3 Scene::middle_of(std::int32_t cell) const {
  Vec3 sum;
  const auto all = corners_of(cell);
  for (const auto vertex : all) sum += point(vertex);
  return (1.0 / static_cast<double>(all.size())) * sum;
}

std::optional<double> Scene::hex_share() const {
  const double total = std::accumulate(volume.begin(), volume.end(), 0.0);
  if ((content != Content::result && content != Content::solution) || !(total > 0)) return std::nullopt;
  return volume[0] / total;
}

const char* name_of(Scene::Content content) {
  constexpr const char* names[] = {"result", "solution", "candidates", "mesh"};
  return names[static_cast<int>(content)];
}

std::size_t place_of(const std::vector<Group>& groups, std::int32_t tag) {
  const auto found =
      std::lower_bound(groups.begin(), groups.end(), tag, [](const Group& group, auto t) { return group.tag < t; });
  return found != groups.end() && found->tag == tag ? static_cast<std::size_t>(found - groups.begin()) : groups.size();
}

}  // namespace hexpipe::viewmesh
