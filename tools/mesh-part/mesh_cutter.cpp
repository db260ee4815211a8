#include "tools/mesh-part/mesh_cutter.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/mesh/item_lists.hpp"
#include "common/mesh/submesh.hpp"

namespace hexpipe::mesh_part {
namespace {

// Two candidates in conflict share a point, which is at most three edges from the vertices where they begin.
constexpr int edges_between_conflicts = 6;

bool has_vertices(const Tet& tet, const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](Vertex v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); });
}

}  // namespace

template <class Item>
auto MeshCutter::lists_by_part(const std::vector<std::int32_t>& parts_of_items, std::int32_t parts) -> Lists<Item> {
  Lists<Item> lists{std::vector<std::int64_t>(parts + 1, 0), std::vector<Item>(parts_of_items.size())};
  for (const std::int32_t part : parts_of_items) ++lists.offsets[part + 1];
  std::partial_sum(lists.offsets.begin(), lists.offsets.end(), lists.offsets.begin());
  std::vector<std::int64_t> next(lists.offsets.begin(), lists.offsets.end() - 1);
  for (std::size_t i = 0; i < parts_of_items.size(); ++i) lists.items[next[parts_of_items[i]]++] = static_cast<Item>(i);
  return lists;
}

MeshCutter::MeshCutter(const TetMesh& mesh, const TetAdjacency& adjacency, const Partition& partition,
                       std::int32_t parts, int edges)
    : mesh_(mesh),
      adjacency_(adjacency),
      partition_(partition),
      parts_(parts),
      edges_(edges),
      own_points_(lists_by_part<Vertex>(partition.point_part, parts)),
      own_tets_(lists_by_part<TetIndex>(partition.tet_part, parts)),
      point_taken_(mesh.points.size(), 0),
      tet_taken_(mesh.tets.size(), no_index) {
  file_triangles();
}

void MeshCutter::file_triangles() {
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const auto triangle = static_cast<std::int32_t>(i);
    const std::size_t before = triangles_.size();
    for (const TetIndex tet : adjacency_.tets_at(mesh_.triangles[i][0]))
      if (has_vertices(mesh_.tets[tet], mesh_.triangles[i])) triangles_.push_back({tet, triangle});
    if (triangles_.size() == before) lone_triangles_.push_back(triangle);
  }
  std::sort(triangles_.begin(), triangles_.end());
}

std::vector<std::int32_t> MeshCutter::points_within(std::int32_t part, int edges) {
  std::vector<std::int32_t> points;
  const auto take = [&](std::int32_t point) {
    if (std::exchange(point_taken_[point], search_) != search_) points.push_back(point);
  };
  ++search_;
  for (const std::int32_t point : own_points_.of(part)) take(point);
  std::size_t next = 0;
  for (int distance = 0; distance < edges; ++distance)
    for (const std::size_t end = points.size(); next < end; ++next)
      for (const Vertex neighbour : adjacency_.neighbours_of(points[next])) take(neighbour);
  return points;
}

std::vector<TetIndex> MeshCutter::tets_of(std::int32_t part) {
  std::vector<TetIndex> tets;
  const auto take = [&](TetIndex tet) {
    if (std::exchange(tet_taken_[tet], part) != part) tets.push_back(tet);
  };
  for (const TetIndex tet : own_tets_.of(part)) take(tet);
  for (const std::int32_t point : points_within(part, edges_))
    for (const TetIndex tet : adjacency_.tets_at(point)) take(tet);
  std::sort(tets.begin(), tets.end());
  return tets;
}

std::vector<std::int32_t> MeshCutter::triangles_of(std::int32_t part, const std::vector<TetIndex>& tets) const {
  std::vector<std::int32_t> triangles;
  if (part == 0) triangles = lone_triangles_;
  auto at = triangles_.begin();
  for (const TetIndex tet : tets) {
    at = std::lower_bound(at, triangles_.end(), TriangleAtTet{tet, 0});
    for (; at != triangles_.end() && at->tet == tet; ++at) triangles.push_back(at->triangle);
  }
  sort_unique(triangles);
  return triangles;
}

std::vector<std::int32_t> MeshCutter::points_of(std::int32_t part, const std::vector<TetIndex>& tets,
                                                const std::vector<std::int32_t>& triangles) {
  const auto own = own_points_.of(part);
  std::vector<std::int32_t> points(own.begin(), own.end());
  for (const TetIndex tet : tets) points.insert(points.end(), mesh_.tets[tet].begin(), mesh_.tets[tet].end());
  for (const std::int32_t triangle : triangles)
    points.insert(points.end(), mesh_.triangles[triangle].begin(), mesh_.triangles[triangle].end());
  sort_unique(points);
  return points;
}

PartOfMesh MeshCutter::cut(std::int32_t part, const MeshFingerprint& whole, const std::vector<std::int8_t>& turns) {
  std::vector<TetIndex> tets = tets_of(part);
  std::vector<std::int32_t> triangles = triangles_of(part, tets);
  std::vector<std::int32_t> points = points_of(part, tets, triangles);
  Submesh cut = submesh(mesh_, std::move(points), std::move(tets), std::move(triangles), scratch_);

  PartOfMesh result;
  MeshPart& about = result.part;
  about.part = part;
  about.parts = parts_;
  about.whole = whole;
  about.point_number.assign(cut.points.begin(), cut.points.end());
  about.tet_number.assign(cut.tets.begin(), cut.tets.end());
  about.triangle_number.assign(cut.triangles.begin(), cut.triangles.end());
  about.point_part = select_items(partition_.point_part, cut.points);
  about.tet_part = select_items(partition_.tet_part, cut.tets);
  if (!turns.empty()) about.tet_turned = select_items(turns, cut.tets);
  for (const std::int32_t point : points_within(part, edges_between_conflicts))
    if (partition_.point_part[point] != part) about.neighbours.push_back(partition_.point_part[point]);
  sort_unique(about.neighbours);
  result.own_tets = static_cast<std::int64_t>(own_tets_.of(part).size());
  result.mesh = std::move(cut.mesh);
  return result;
}

}  // namespace hexpipe::mesh_part
