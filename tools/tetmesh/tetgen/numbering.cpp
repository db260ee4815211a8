#include "tools/tetmesh/tetgen/numbering.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/reorder.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::tetgen {
namespace {

constexpr int bits_an_axis = 21;  // three of them fit 64 bits

// Leaves two empty bits behind each of the lowest 21 bits.
std::uint64_t spread_bits(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffffu;
  bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
  return (bits | bits << 2) & 0x1249249249249249u;
}

// The places along the curve. All axes have one unit, so that cells of the curve are cubes.
std::vector<std::pair<std::uint64_t, Vertex>> places_along_curve(const std::vector<Vec3>& points) {
  const Box box = Box::around(points);
  const Vec3 extent = box.high - box.low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  const double unit = longest > 0 ? ((1 << bits_an_axis) - 1) / longest : 0;
  std::vector<std::pair<std::uint64_t, Vertex>> places(points.size());
  parallel_for(static_cast<std::int64_t>(points.size()), 1024, [&](std::int64_t v) {
    const Vec3 at = unit * (points[v] - box.low);
    const auto spread = [](double x) { return spread_bits(static_cast<std::uint64_t>(x)); };
    places[v] = {spread(at.x) | spread(at.y) << 1 | spread(at.z) << 2, static_cast<Vertex>(v)};
  });
  return places;
}

void number_vertices(TetMesh& mesh, std::size_t added) {
  auto places = places_along_curve(mesh.points);
  std::sort(places.begin(), places.end() - static_cast<std::ptrdiff_t>(added));
  std::vector<Vertex> order(places.size()), number(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    order[i] = places[i].second;
    number[order[i]] = static_cast<Vertex>(i);
  }
  reorder(mesh.points, order);
  for (Tet& tet : mesh.tets)
    for (Vertex& v : tet) v = number[v];
  for (Triangle& triangle : mesh.triangles)
    for (Vertex& v : triangle) v = number[v];
}

// Tets with the same lowest vertex keep their order.
void number_tets(TetMesh& mesh) {
  const auto lowest = [](const Tet& tet) { return static_cast<std::size_t>(*std::ranges::min_element(tet)); };
  std::vector<std::int32_t> next(mesh.points.size() + 1, 0);
  for (const Tet& tet : mesh.tets) ++next[lowest(tet) + 1];
  for (std::size_t v = 1; v < next.size(); ++v) next[v] += next[v - 1];
  std::vector<std::int32_t> order(mesh.tets.size());
  for (std::size_t t = 0; t < order.size(); ++t) order[next[lowest(mesh.tets[t])]++] = static_cast<std::int32_t>(t);
  reorder(mesh.tets, order);
  if (!mesh.tet_tags.empty()) reorder(mesh.tet_tags, order);
}

}  // namespace

void number_along_curve(TetMesh& mesh, std::size_t added) {
  if (mesh.points.empty()) return;
  number_vertices(mesh, added);
  number_tets(mesh);
}

}  // namespace hexpipe::tetmesh::tetgen
