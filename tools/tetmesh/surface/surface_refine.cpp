#include "tools/tetmesh/surface/surface_refine.hpp"

#include <queue>

#include "tools/tetmesh/surface/delaunay_flips.hpp"

namespace hexpipe {
namespace {

void flip_flat_edges(FeatureMesh& mesh, double flatness) {
  EdgeQueue queue;
  for (const auto e : mesh.edges()) queue.push(e);
  flip_towards_delaunay(
      mesh, queue,
      [&](OpenMesh::EdgeHandle, const EdgeDiamond& diamond) {
        return diamond.height() <= flatness && diamond.least_cosine_after_flip() > 0.999;
      },
      [](OpenMesh::EdgeHandle) {});
}

double squared_length(const FeatureMesh& mesh, OpenMesh::EdgeHandle e) {
  const auto h = mesh.halfedge_handle(e, 0);
  return norm_squared(mesh.position(mesh.to_vertex_handle(h)) - mesh.position(mesh.from_vertex_handle(h)));
}

void halve_long_edges(FeatureMesh& mesh, double longest) {
  std::priority_queue<std::pair<double, int>> queue;
  auto offer = [&](OpenMesh::EdgeHandle e) {
    const double length = squared_length(mesh, e);
    if (length > longest * longest) queue.emplace(length, -e.idx());
  };
  for (const auto e : mesh.edges()) offer(e);
  while (!queue.empty()) {
    const auto [length, number] = queue.top();
    queue.pop();
    const auto e = mesh.edge_handle(static_cast<unsigned>(-number));
    if (squared_length(mesh, e) != length) continue;  // halved since
    const auto h = mesh.halfedge_handle(e, 0);
    const Vec3 middle = 0.5 * (mesh.position(mesh.to_vertex_handle(h)) + mesh.position(mesh.from_vertex_handle(h)));
    for (const auto part : mesh.ve_range(mesh.split_edge_at(e, middle))) offer(part);
  }
}

}  // namespace

void refine_surface(FeatureMesh& mesh, double longest, double flatness) {
  flip_flat_edges(mesh, flatness);
  halve_long_edges(mesh, longest);
  flip_flat_edges(mesh, flatness);
}

}  // namespace hexpipe
