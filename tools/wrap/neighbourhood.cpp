#include "tools/wrap/neighbourhood.hpp"

#include <algorithm>
#include <iterator>

namespace hexpipe::wrap {

TrianglesAround triangles_around(const Surface& surface) {
  TrianglesAround around(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const Vertex v : surface.triangles[t]) around[v].push_back(static_cast<std::int32_t>(t));
  return around;
}

std::vector<Vertex> neighbours(const Surface& surface, const std::vector<std::int32_t>& around, Vertex v) {
  std::vector<Vertex> result;
  for (const std::int32_t t : around)
    for (const Vertex w : surface.triangles[t])
      if (w != v) result.push_back(w);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

bool may_merge(const Surface& surface, const TrianglesAround& around, Vertex v, Vertex w) {
  const auto a = neighbours(surface, around[v], v), b = neighbours(surface, around[w], w);
  std::vector<Vertex> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  if (common.size() != 2) return false;
  if (a.size() > 3) return true;
  // Otherwise two triangles would lie on each other.
  return std::none_of(around[w].begin(), around[w].end(), [&](std::int32_t t) {
    return has(surface.triangles[t], common[0]) && has(surface.triangles[t], common[1]);
  });
}

void leave_out_merged_triangles(Surface& surface) {
  std::erase_if(surface.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

}  // namespace hexpipe::wrap
