#include "common/candidates/tet_order.hpp"

#include <algorithm>
#include <numeric>

namespace hexpipe::candidates {
namespace {

Vertex lowest_vertex(const Tet& tet) {
  return std::min(std::min(tet[0], tet[1]), std::min(tet[2], tet[3]));
}

}  // namespace

std::vector<std::int32_t> order_by_lowest_vertex(const TetMesh& mesh) {
  std::vector<std::int32_t> order;
  if (std::ranges::is_sorted(mesh.tets, {}, lowest_vertex)) return order;
  std::vector<std::int32_t> next(mesh.points.size() + 1, 0);
  for (const Tet& tet : mesh.tets) ++next[lowest_vertex(tet) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  order.resize(mesh.tets.size());
  for (std::size_t t = 0; t < order.size(); ++t)
    order[next[lowest_vertex(mesh.tets[t])]++] = static_cast<std::int32_t>(t);
  return order;
}

}  // namespace hexpipe::candidates
