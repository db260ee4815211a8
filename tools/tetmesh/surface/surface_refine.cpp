#include "tools/tetmesh/surface/remesh_steps.hpp"

#include <queue>

#include "tools/tetmesh/surface/delaunay_flips.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// Calls done(edge) for each edge that it flips.
template <class Done>
void flip_flat_edges(FeatureMesh& mesh, EdgeQueue& queue, const sizing::SizeField& flatness, Done&& done) {
  flip_towards_delaunay(
      mesh, queue,
      [&](OpenMesh::EdgeHandle, const EdgeDiamond& diamond) {
        return flatness.is_at_least(diamond.height(), diamond.end_points[0]) &&
               diamond.least_cosine_after_flip() > 0.999;
      },
      done);
}

std::array<Vec3, 2> ends_of(const FeatureMesh& mesh, OpenMesh::EdgeHandle e) {
  const auto h = mesh.halfedge_handle(e, 0);
  return {mesh.position(mesh.from_vertex_handle(h)), mesh.position(mesh.to_vertex_handle(h))};
}

// In units of the longest length that is allowed in the edge's middle.
double squared_length(const FeatureMesh& mesh, OpenMesh::EdgeHandle e, const sizing::SizeField& longest) {
  const auto [from, to] = ends_of(mesh, e);
  const double allowed = longest.at(0.5 * (from + to));
  return norm_squared(to - from) / (allowed * allowed);
}

// The flips after each halving matter in fans of slivers, which share the ends of their long edges: without them, each
// sliver would get points of its own.
void halve_long_edges(FeatureMesh& mesh, const sizing::SizeField& longest, const sizing::SizeField& flatness) {
  std::priority_queue<std::pair<double, int>> queue;
  EdgeQueue changed;
  auto offer = [&](OpenMesh::EdgeHandle e) {
    const double length = squared_length(mesh, e, longest);
    if (length > 1) queue.emplace(length, -e.idx());
  };
  for (const auto e : mesh.edges()) offer(e);
  while (!queue.empty()) {
    const auto [length, number] = queue.top();
    queue.pop();
    const auto e = mesh.edge_handle(static_cast<unsigned>(-number));
    if (squared_length(mesh, e, longest) != length) continue;  // it was halved or flipped since
    const auto [from, to] = ends_of(mesh, e);
    const auto middle = mesh.split_edge_at(e, 0.5 * (from + to));
    mesh.for_each_copy(middle, [&](OpenMesh::VertexHandle copy) {
      for (const auto part : mesh.ve_range(copy)) offer(part);
      for (const auto f : mesh.vf_range(copy))
        for (const auto around : mesh.fe_range(f)) changed.push(around);
    });
    flip_flat_edges(mesh, changed, flatness, offer);
  }
}

}  // namespace

void refine_surface(FeatureMesh& mesh, const sizing::SizeField& longest, const sizing::SizeField& flatness) {
  EdgeQueue all;
  for (const auto e : mesh.edges()) all.push(e);
  flip_flat_edges(mesh, all, flatness, [](OpenMesh::EdgeHandle) {});
  halve_long_edges(mesh, longest, flatness);
}

}  // namespace hexpipe::tetmesh::surface
