#include "formats/polyhedra/local_changes.hpp"

#include <map>
#include <set>

namespace hexpipe::polyhedra {

CellSet with_neighbours(const MeasuredMesh& mesh, const CellSet& cells) {
  CellSet all = cells;
  for (const std::int32_t cell : cells)
    for (const std::int32_t face : mesh.faces_of(cell))
      if (mesh.mesh().faces[face].is_inner()) all.push_back(mesh.mesh().faces[face].other_cell(cell));
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

std::vector<Vertex> loop_from(const MeasuredMesh& mesh, std::int32_t face, std::int32_t cell) {
  const auto corners = mesh.mesh().corners_of(mesh.mesh().faces[face]);
  std::vector<Vertex> loop(corners.begin(), corners.end());
  if (mesh.mesh().faces[face].owner != cell) std::ranges::reverse(loop);
  return loop;
}

std::vector<Vertex> loop_around(const std::vector<std::vector<Vertex>>& faces) {
  std::set<std::pair<Vertex, Vertex>> edges;
  for (const auto& face : faces)
    for (const auto& [a, b] : edges_of(face)) edges.emplace(a, b);
  std::map<Vertex, Vertex> next;
  Vertex first = no_index;
  std::size_t count = 0;
  for (const auto& face : faces)
    for (const auto& [a, b] : edges_of(face)) {
      if (edges.contains({b, a})) continue;
      if (!next.emplace(a, b).second) return {};
      if (first == no_index) first = a;
      ++count;
    }
  std::vector<Vertex> loop;
  for (Vertex at = first; loop.size() < count;) {
    loop.push_back(at);
    const auto found = next.find(at);
    if (found == next.end()) return {};
    at = found->second;
    if (at == first) break;
  }
  return loop.size() == count && count >= 3 ? loop : std::vector<Vertex>{};
}

std::vector<Vertex> part_of_loop(const std::vector<Vertex>& loop, std::size_t first, std::size_t last) {
  std::vector<Vertex> part;
  for (std::size_t i = first;; i = (i + 1) % loop.size()) {
    part.push_back(loop[i]);
    if (i == last) return part;
  }
}

bool has_corner(const MeasuredMesh& mesh, std::int32_t face, Vertex vertex) {
  const auto corners = mesh.mesh().corners_of(mesh.mesh().faces[face]);
  return std::ranges::find(corners, vertex) != corners.end();
}

bool has_edge(const MeasuredMesh& mesh, std::int32_t face, Vertex a, Vertex b) {
  const auto corners = mesh.mesh().corners_of(mesh.mesh().faces[face]);
  for (const auto& [from, to] : edges_of(corners))
    if ((from == a && to == b) || (from == b && to == a)) return true;
  return false;
}

RefusalCount count_refusals(const MeasuredMesh& mesh, const CellSet& cells) {
  RefusalCount result;
  const auto add = [&](Refusals refusals) {
    result.wrong += (refusals & wrong) != 0 ? 1 : 0;
    result.severe += (refusals & severe) != 0 ? 1 : 0;
  };
  for (const std::int32_t cell : cells) {
    if (!mesh.is_alive(cell)) continue;
    add(mesh.refusals_of_cell(cell));
    for (const std::int32_t face : mesh.faces_of(cell)) {
      const std::int32_t other = mesh.mesh().faces[face].other_cell(cell);
      if (other == no_index || other > cell || !contains(cells, other)) add(mesh.refusals_of_face(face));
    }
  }
  return result;
}

}  // namespace hexpipe::polyhedra
