#include "common/mesh/submesh.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "common/mesh/item_lists.hpp"

namespace hexpipe {
namespace {

template <class Cell>
bool has_marked(const Cell& cell, const std::vector<bool>& marked) {
  return std::any_of(cell.begin(), cell.end(), [&](Vertex v) { return marked[v]; });
}

template <class Cell>
bool all_marked(const Cell& cell, const std::vector<bool>& marked) {
  return std::all_of(cell.begin(), cell.end(), [&](Vertex v) { return marked[v]; });
}

std::vector<std::int32_t> where_true(const std::vector<bool>& marked) {
  std::vector<std::int32_t> places;
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) places.push_back(static_cast<std::int32_t>(i));
  return places;
}

// The ridges with both ends among the points. places[p] is the new number of point p.
std::vector<Ridge> ridges_among(const std::vector<Ridge>& ridges, std::span<const std::int32_t> points,
                                std::span<const std::int32_t> places) {
  std::vector<Ridge> selected;
  const auto is_among = [&](Vertex v) {
    const auto place = static_cast<std::size_t>(places[v]);
    return place < points.size() && points[place] == v;
  };
  for (const auto& [a, b] : ridges)
    if (is_among(a) && is_among(b)) selected.push_back({places[a], places[b]});
  return selected;
}

}  // namespace

Submesh submesh(const TetMesh& mesh, std::vector<Vertex> points, std::vector<TetIndex> tets,
                std::vector<std::int32_t> triangles, std::vector<std::int32_t>& scratch) {
  Submesh result{{}, std::move(points), std::move(tets), std::move(triangles)};
  result.mesh.points = select_items(mesh.points, result.points);
  result.mesh.tets = select_items(mesh.tets, result.tets);
  result.mesh.tet_tags = select_items(mesh.tet_tags, result.tets);
  result.mesh.triangles = select_items(mesh.triangles, result.triangles);
  result.mesh.triangle_tags = select_items(mesh.triangle_tags, result.triangles);
  scratch.resize(mesh.points.size());
  for (std::size_t i = 0; i < result.points.size(); ++i) scratch[result.points[i]] = static_cast<std::int32_t>(i);
  const auto renumber = [&](auto& cells) {
    for (auto& cell : cells)
      for (Vertex& v : cell) v = scratch[v];
  };
  renumber(result.mesh.tets);
  renumber(result.mesh.triangles);
  if (mesh.ridges) result.mesh.ridges = ridges_among(*mesh.ridges, result.points, scratch);
  return result;
}

Submesh submesh_around(const TetMesh& mesh, const std::vector<bool>& marked, int edges) {
  std::vector<bool> reached = marked;
  std::vector<TetIndex> tets;
  for (int distance = 0; distance <= edges; ++distance) {
    tets.clear();
    std::vector<bool> next = reached;
    for (const auto t : indices<TetIndex>(mesh.tets.size())) {
      if (!has_marked(mesh.tets[t], reached)) continue;
      tets.push_back(t);
      for (const Vertex v : mesh.tets[t]) next[v] = true;
    }
    reached = std::move(next);
  }
  std::vector<std::int32_t> triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (all_marked(mesh.triangles[i], reached)) triangles.push_back(static_cast<std::int32_t>(i));
  std::vector<std::int32_t> scratch;
  return submesh(mesh, where_true(reached), std::move(tets), std::move(triangles), scratch);
}

}  // namespace hexpipe
