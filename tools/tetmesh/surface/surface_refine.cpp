#include "tools/tetmesh/surface/surface_refine.hpp"

#include <queue>

#include "tools/tetmesh/surface/delaunay_flips.hpp"

namespace hexpipe {
namespace {

void flip_flat_edges(FeatureMesh& mesh, const SizeField& flatness) {
  EdgeQueue queue;
  for (const auto e : mesh.edges()) queue.push(e);
  flip_towards_delaunay(
      mesh, queue,
      [&](OpenMesh::EdgeHandle, const EdgeDiamond& diamond) {
        return diamond.height() <= flatness.at(diamond.end_points[0]) && diamond.least_cosine_after_flip() > 0.999;
      },
      [](OpenMesh::EdgeHandle) {});
}

std::array<Vec3, 2> ends_of(const FeatureMesh& mesh, OpenMesh::EdgeHandle e) {
  const auto h = mesh.halfedge_handle(e, 0);
  return {mesh.position(mesh.from_vertex_handle(h)), mesh.position(mesh.to_vertex_handle(h))};
}

// Against the longest that is allowed in its middle.
double squared_length(const FeatureMesh& mesh, OpenMesh::EdgeHandle e, const SizeField& longest) {
  const auto [from, to] = ends_of(mesh, e);
  const double allowed = longest.at(0.5 * (from + to));
  return norm_squared(to - from) / (allowed * allowed);
}

void halve_long_edges(FeatureMesh& mesh, const SizeField& longest) {
  std::priority_queue<std::pair<double, int>> queue;
  auto offer = [&](OpenMesh::EdgeHandle e) {
    const double length = squared_length(mesh, e, longest);
    if (length > 1) queue.emplace(length, -e.idx());
  };
  for (const auto e : mesh.edges()) offer(e);
  while (!queue.empty()) {
    const auto [length, number] = queue.top();
    queue.pop();
    const auto e = mesh.edge_handle(static_cast<unsigned>(-number));
    if (squared_length(mesh, e, longest) != length) continue;  // halved since
    const auto [from, to] = ends_of(mesh, e);
    for (const auto part : mesh.ve_range(mesh.split_edge_at(e, 0.5 * (from + to)))) offer(part);
  }
}

}  // namespace

void refine_surface(FeatureMesh& mesh, const SizeField& longest, const SizeField& flatness) {
  flip_flat_edges(mesh, flatness);
  halve_long_edges(mesh, longest);
  flip_flat_edges(mesh, flatness);
}

}  // namespace hexpipe
