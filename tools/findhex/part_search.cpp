#include "tools/findhex/part_search.hpp"

#include "common/mesh/submesh.hpp"

namespace hexpipe::findhex {
namespace {

// No two corners of a cell are more edges apart.
constexpr int edges_across_cell = 3;

candidates::SearchScope scope_of(const Submesh& part_searched, const MeshPart& part) {
  candidates::SearchScope scope;
  for (const std::int32_t point : part_searched.points) scope.begins_at.push_back(part.point_part[point] == part.part);
  if (!part.tet_turned.empty())
    for (const TetIndex tet : part_searched.tets) scope.turns.push_back(part.tet_turned[tet]);
  return scope;
}

void renumber(std::vector<TetIndex>& tets, const std::vector<TetIndex>& numbers) {
  for (TetIndex& tet : tets) tet = numbers[tet];
}

}  // namespace

// A cell and its tets depend only on the tets at its corners. Tets further out, which the part has for buildgraph,
// would only take memory.
candidates::FindhexResult findhex_of_part(const TetMesh& mesh, const MeshPart& part,
                                          const candidates::FindhexOptions& options, const char* source) {
  std::vector<bool> own(mesh.points.size());
  for (std::size_t v = 0; v < own.size(); ++v) own[v] = part.point_part[v] == part.part;
  Submesh searched = submesh_around(mesh, own, edges_across_cell);
  const candidates::SearchScope scope = scope_of(searched, part);
  candidates::FindhexResult result = candidates::findhex(std::move(searched.mesh), options, source, scope);
  for (auto& corners : result.candidates.vertices)
    for (Vertex& v : corners)
      if (v != no_index) v = searched.points[v];
  renumber(result.candidates.tets, searched.tets);
  renumber(result.candidates.boundary_tets, searched.tets);
  return result;
}

}  // namespace hexpipe::findhex
