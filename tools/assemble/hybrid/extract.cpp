#include "tools/assemble/hybrid/extract.hpp"

#include <algorithm>
#include <utility>

namespace hexpipe::assemble::hybrid {
namespace {

// The quad, turned the way that the input's triangle, one of its halves, goes around.
Quad oriented_like(const Triangle& triangle, const Quad& quad) {
  const auto at = std::find(quad.begin(), quad.end(), triangle[0]) - quad.begin();
  const auto next = std::find(quad.begin(), quad.end(), triangle[1]) - quad.begin();
  const auto last = std::find(quad.begin(), quad.end(), triangle[2]) - quad.begin();
  // Going forward from the first, the second comes before the third.
  const bool forward = (next - at + 4) % 4 < (last - at + 4) % 4;
  Quad result;
  for (int i = 0; i < 4; ++i) result[i] = quad[static_cast<std::size_t>(forward ? at + i : at - i + 4) % 4];
  return result;
}

void append_facets(MixedMesh& result, const HybridMesh& mesh, const SurfaceTags& tags) {
  // By input triangle: whether a quad covers it.
  std::vector<bool> covered(tags.size());
  std::vector<std::pair<TaggedTriangle, Quad>> quads;
  for (const auto c : indices<CellIndex>(mesh.cell_count())) {
    if (!mesh.cell(c).alive) continue;
    for (int i = 0; i < mesh.cell(c).quad_count(); ++i) {
      const auto cover = tags.cover_of(mesh.cell(c).quad(i));
      if (!cover || covered[cover->triangles[0]]) continue;
      covered[cover->triangles[0]] = covered[cover->triangles[1]] = true;
      quads.emplace_back(std::min(cover->triangles[0], cover->triangles[1]), mesh.cell(c).quad(i));
    }
  }
  std::sort(quads.begin(), quads.end());
  for (const auto& [triangle, quad] : quads)
    append(result.quads, oriented_like(tags.triangle(triangle), quad), tags.tag_of(triangle));
  for (const auto i : indices<TaggedTriangle>(covered.size()))
    if (!covered[i] && tags.find(tags.triangle(i)) == i) append(result.triangles, tags.triangle(i), tags.tag_of(i));
}

template <int Corners>
void mark_used(const CellBlock<Corners>& block, std::vector<Vertex>& numbers) {
  for (const auto& cell : block.cells)
    for (Vertex v : cell) numbers[v] = 0;
}

template <int Corners>
void renumber(CellBlock<Corners>& block, const std::vector<Vertex>& numbers) {
  for (auto& cell : block.cells)
    for (Vertex& v : cell) v = numbers[v];
}

void drop_unused_points(Extract& extract, const std::vector<Vec3>& points) {
  MixedMesh& result = extract.mesh;
  std::vector<Vertex> numbers(points.size(), no_index);
  mark_used(result.hexes, numbers), mark_used(result.prisms, numbers), mark_used(result.pyramids, numbers);
  mark_used(result.tets, numbers);
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (numbers[v] == no_index) continue;
    numbers[v] = static_cast<Vertex>(result.points.size());
    result.points.push_back(points[v]);
    extract.origin.push_back(static_cast<Vertex>(v));
  }
  renumber(result.hexes, numbers), renumber(result.prisms, numbers), renumber(result.pyramids, numbers);
  renumber(result.tets, numbers), renumber(result.triangles, numbers), renumber(result.quads, numbers);
}

}  // namespace

void append_cell(MixedMesh& mesh, CellKind kind, std::span<const Vertex> corners, std::int32_t tag) {
  switch (kind) {
    case CellKind::hex:
      return append(mesh.hexes, corners, tag);
    case CellKind::prism:
      return append(mesh.prisms, corners, tag);
    case CellKind::pyramid:
      return append(mesh.pyramids, corners, tag);
    case CellKind::tet:
      return append(mesh.tets, corners, tag);
  }
}

Extract extract(const HybridMesh& mesh, const SurfaceTags& tags) {
  Extract result;
  for (const auto c : indices<CellIndex>(mesh.cell_count()))
    if (const HybridCell& cell = mesh.cell(c); cell.alive)
      append_cell(result.mesh, cell.kind, cell.corners, cell.region);
  for (const auto t : indices<TetIndex>(mesh.tet_count()))
    if (mesh.is_alive(t)) append(result.mesh.tets, mesh.tet(t), mesh.region_of(t));
  append_facets(result.mesh, mesh, tags);
  drop_unused_points(result, mesh.points);
  return result;
}

namespace {

template <int Corners>
void drop_tagged(CellBlock<Corners>& block, std::int32_t tag) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (block.tags[i] == tag) continue;
    if (!block.quality.empty()) block.quality[kept] = block.quality[i];
    block.cells[kept] = block.cells[i];
    block.tags[kept++] = block.tags[i];
  }
  if (!block.quality.empty()) block.quality.resize(kept);
  block.cells.resize(kept);
  block.tags.resize(kept);
}

Extract without_facets(Extract from, std::int32_t tag) {
  drop_tagged(from.mesh.triangles, tag), drop_tagged(from.mesh.quads, tag);
  return from;
}

}  // namespace

Extract without_guests(const Extract& from, const Seam& seam) {
  Extract result = without_facets({from.mesh, {}}, seam.guest_tag);
  MixedMesh& mesh = result.mesh;
  drop_tagged(mesh.hexes, seam.guest_region), drop_tagged(mesh.prisms, seam.guest_region);
  drop_tagged(mesh.pyramids, seam.guest_region), drop_tagged(mesh.tets, seam.guest_region);
  mesh.points.clear();
  drop_unused_points(result, from.mesh.points);
  for (Vertex& v : result.origin) v = from.origin[v];
  return result;
}

Extract without_seam_facets(Extract from, const Seam& seam) {
  return without_facets(std::move(from), seam.seam_tag);
}

}  // namespace hexpipe::assemble::hybrid
