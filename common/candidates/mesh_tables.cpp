#include "common/candidates/mesh_tables.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/orientation.hpp"
#include "common/mesh/reorder.hpp"
#include "common/run/memory.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::candidates {
namespace {

constexpr std::int32_t derived_tag = 0;

Vertex lowest_vertex(const Tet& tet) {
  return std::min(std::min(tet[0], tet[1]), std::min(tet[2], tet[3]));
}

// The numbers of the mesh's tets by lowest vertex, ascending at each vertex; empty if they are already in this order. A
// search goes from vertex to vertex, so the tets that it asks about are then close in memory to those before.
std::vector<TetIndex> order_by_lowest_vertex(const TetMesh& mesh) {
  std::vector<TetIndex> order;
  if (std::ranges::is_sorted(mesh.tets, {}, lowest_vertex)) return order;
  std::vector<std::int32_t> next(mesh.points.size() + 1, 0);
  for (const Tet& tet : mesh.tets) ++next[lowest_vertex(tet) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  order.resize(mesh.tets.size());
  for (const auto t : indices<TetIndex>(order.size())) order[next[lowest_vertex(mesh.tets[t])]++] = t;
  return order;
}

// Which facet of a tet these three vertices are, and whether in the sense of TetTopology::triangles.
struct FoundFacet {
  int facet;
  bool from_outside;
};
FoundFacet facet_of(const Tet& tet, const Triangle& triangle) {
  const auto corner_of = [&](Vertex v) { return static_cast<int>(std::find(tet.begin(), tet.end(), v) - tet.begin()); };
  const int a = corner_of(triangle[0]), b = corner_of(triangle[1]), c = corner_of(triangle[2]);
  const int facet = 0 + 1 + 2 + 3 - a - b - c;
  const LocalTriangle& listed = TetTopology::triangles[facet];
  const auto at = std::find(listed.begin(), listed.end(), a) - listed.begin();
  return {facet, listed[(at + 1) % 3] == b};
}

}  // namespace

MeshTables::MeshTables(TetMesh mesh, const char* source, const std::vector<std::int8_t>& turns, double feature_angle)
    : mesh_(std::move(mesh)),
      feature_cosine_(cosine_of_degrees(feature_angle)),
      ridges_(ridges_of(mesh_)),
      findings_{.orientation = turns.empty() ? orient_tets(mesh_, source) : orient_tets(mesh_, turns)},
      tet_order_(order_by_lowest_vertex(mesh_)),
      usable_(order_tets()),
      adjacency_(mesh_, source, tet_order_) {
  check_sides(mesh_, adjacency_, source, tet_order_);
  both_at_once([this] { links_.emplace(mesh_, adjacency_, usable_); },
               [this] {
                 make_flood_tets();
                 label_walls();
               });
}

// Returns which tets are usable, in the new order.
std::vector<bool> MeshTables::order_tets() {
  if (!tet_order_.empty()) {
    reorder(mesh_.tets, tet_order_);
    reorder(mesh_.tet_tags, tet_order_);
  }
  std::vector<bool> usable(mesh_.tets.size());
  for (const auto t : indices<TetIndex>(usable.size())) usable[t] = findings_.orientation.signs[number_in_mesh(t)] > 0;
  return usable;
}

template <class Visit>
void MeshTables::for_each_tet_at(const Triangle& facet, Visit&& visit) const {
  auto tets = adjacency_.tets_at(facet[0]);
  for (const Vertex v : facet)
    if (const auto others = adjacency_.tets_at(v); others.size() < tets.size()) tets = others;
  const auto has = [](const Tet& tet, Vertex v) {
    // Without branches, which would be foretold badly.
    return (int{tet[0] == v} | int{tet[1] == v} | int{tet[2] == v} | int{tet[3] == v}) != 0;
  };
  for (const TetIndex t : tets) {
    const Tet& tet = mesh_.tets[t];
    if (has(tet, facet[0]) && has(tet, facet[1]) && has(tet, facet[2])) visit(t, facet_of(tet, facet));
  }
}

TetIndex MeshTables::tet_inside(Vertex a, Vertex b, Vertex c) const {
  TetIndex inside = no_index;
  for_each_tet_at({a, b, c}, [&](TetIndex t, const FoundFacet& found) {
    if (usable_[t] && found.from_outside) inside = t;
  });
  return inside;
}

bool MeshTables::is_sharp(Vertex a, Vertex b, Vertex c, Vertex d) const {
  const auto& p = mesh_.points;
  const Vec3 diagonal = p[c] - p[a];
  const Vec3 normal = cross(p[b] - p[a], diagonal), next_normal = cross(diagonal, p[d] - p[a]);
  return !(dot(normal, next_normal) >= feature_cosine_ * norm(normal) * norm(next_normal)) ||
         (!ridges_.empty() && ridges_.contains(edge_key(a, c)));
}

void MeshTables::make_flood_tets() {
  resize_in_huge_pages(flood_tets_, mesh_.tets.size());
  for (const auto t : indices<TetIndex>(flood_tets_.size())) {
    FloodTet& tet = flood_tets_[t];
    tet.vertices = mesh_.tets[t];
    const auto beyond = adjacency_.tets_beyond(t);
    for (std::size_t facet = 0; facet < beyond.size(); ++facet) {
      if (beyond[facet] != no_index && usable_[beyond[facet]]) {
        tet.across[facet] = {beyond[facet]};
        continue;
      }
      tet.across[facet] = Beyond::wall(walls_.size());
      walls_.push_back({no_index, 0});
    }
  }
}

// Afterwards, every facet on the boundary or between regions has a triangle.
void MeshTables::label_walls() {
  findings_.derived_triangles =
      static_cast<std::int64_t>(add_missing_boundary_triangles(mesh_, adjacency_, derived_tag));
  std::vector<std::int32_t> tags = mesh_.triangle_tags;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  // If several triangles are at one place, the first one counts.
  for (std::size_t i = mesh_.triangles.size(); i-- > 0;) {
    const auto tag =
        static_cast<std::int32_t>(std::lower_bound(tags.begin(), tags.end(), mesh_.triangle_tags[i]) - tags.begin());
    for_each_tet_at(mesh_.triangles[i], [&](TetIndex t, const FoundFacet& found) {
      const bool is_inside = adjacency_.tet_beyond(t, found.facet) != no_index;
      Beyond& across = flood_tets_[t].across[found.facet];
      if (!across.is_wall()) {
        walls_.push_back({across.tet(), 0});
        across = Beyond::wall(walls_.size() - 1);
      }
      walls_[across.wall_number()].label = 2 * (tag + 1) + (is_inside ? 1 : 0);
    });
  }
}

}  // namespace hexpipe::candidates
