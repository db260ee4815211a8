#include "tools/tetmesh/surface/mesh_regions.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "tools/tetmesh/geometry/triangle_boxes.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

constexpr std::size_t most_regions = 64;

std::size_t region_count(std::size_t vertices, std::size_t most) {
  if (4 * vertices < most) return 1;
  std::size_t count = 2;
  while (count < most_regions && vertices > count * most) count *= 2;
  return count;
}

}  // namespace

MeshRegions::MeshRegions(const FeatureMesh& mesh, std::size_t most)
    : size_(region_count(mesh.n_vertices(), most)), of_(mesh.n_vertices()) {
  std::vector<int> order(mesh.n_vertices());
  std::iota(order.begin(), order.end(), 0);
  const auto position = [&](int v) { return mesh.position(mesh.vertex_handle(static_cast<unsigned>(v))); };
  const auto halve = [&](const auto& self, std::span<int> vertices, std::size_t first, std::size_t count) -> void {
    if (count == 1) {
      for (const int v : vertices) of_[v] = static_cast<std::uint8_t>(first);
      return;
    }
    geometry::Box box{position(vertices[0]), position(vertices[0])};
    for (const int v : vertices) box.add({position(v), position(v)});
    const int axis = box.longest_axis();
    const std::size_t half = vertices.size() / 2;
    std::ranges::nth_element(vertices, vertices.begin() + static_cast<std::ptrdiff_t>(half), {},
                             [&](int v) { return std::pair(position(v)[axis], v); });
    self(self, vertices.first(half), first, count / 2);
    self(self, vertices.subspan(half), first + count / 2, count / 2);
  };
  halve(halve, order, 0, size_);
}

// is_collapse_ok() marks the neighbours of the end, and flips around these follow.
bool MeshRegions::has_around(std::size_t region, const FeatureMesh& mesh, OpenMesh::VertexHandle v) const {
  const auto is_in = [&](OpenMesh::VertexHandle u) { return of(u) == region; };
  // The neighbours of a vertex elsewhere are not read.
  for (const auto u : mesh.vv_range(v))
    if (!is_in(u)) return false;
  for (const auto u : mesh.vv_range(v))
    for (const auto w : mesh.vv_range(u))
      if (!is_in(w)) return false;
  return true;
}

bool MeshRegions::has(std::size_t region, const EdgeDiamond& diamond) const {
  const auto is_in = [&](OpenMesh::VertexHandle u) { return of(u) == region; };
  return std::ranges::all_of(diamond.ends, is_in) && std::ranges::all_of(diamond.across, is_in);
}

}  // namespace hexpipe::tetmesh::surface
