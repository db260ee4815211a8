#include "formats/meshes/mesh_writing.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"
#include "formats/meshes/facet_table.hpp"
#include "formats/meshes/mesh_blocks.hpp"

namespace hexpipe::formats {
namespace {

template <class Topology, class Block>
void add_quads(const Block& block, KeySet<4>& quads) {
  for (const auto& cell : block.cells)
    for (const LocalQuad& corners : Topology::quads) quads.insert(key_of(pick(cell, corners)));
}

// The same quad, beginning with its lowest vertex.
std::array<Vertex, 4> from_lowest(std::array<Vertex, 4> quad) {
  std::ranges::rotate(quad, std::ranges::min_element(quad));
  return quad;
}

// Adds the pyramids' tets, and cuts facets of pyramids alone in two.
void split_cells(const CellBlock<5>& pyramids, CellBlock<4>& tets) {
  for (std::size_t i = 0; i < pyramids.size(); ++i) {
    const auto& cell = pyramids.cells[i];
    const auto [a, b, c, d] = from_lowest({cell[0], cell[1], cell[2], cell[3]});
    for (const auto& tet : {std::array{a, b, c, cell[4]}, std::array{a, c, d, cell[4]}}) {
      tets.cells.push_back(tet);
      tets.tags.push_back(pyramids.tags[i]);
    }
  }
}

}  // namespace

MixedMesh with_split_pyramids(const MixedMesh& mesh) {
  MixedMesh result = mesh;
  KeySet<4> bases, others;
  add_quads<PyramidTopology>(mesh.pyramids, bases);
  add_quads<HexTopology>(mesh.hexes, others);
  add_quads<PrismTopology>(mesh.prisms, others);
  result.pyramids = {};
  // The new cells have no quality yet.
  for_each_block(result, [](const ElementNames&, auto& block) { block.quality.clear(); });
  split_cells(mesh.pyramids, result.tets);
  result.quads = {};
  for (std::size_t i = 0; i < mesh.quads.size(); ++i) {
    const auto& quad = mesh.quads.cells[i];
    if (!bases.contains(key_of(quad)) || others.contains(key_of(quad))) {
      result.quads.cells.push_back(quad);
      result.quads.tags.push_back(mesh.quads.tags[i]);
      continue;
    }
    const auto [a, b, c, d] = from_lowest(quad);
    for (const auto& triangle : {std::array{a, b, c}, std::array{a, c, d}}) {
      result.triangles.cells.push_back(triangle);
      result.triangles.tags.push_back(mesh.quads.tags[i]);
    }
  }
  return result;
}

void check_numbers(std::size_t count, std::size_t most, std::string_view name) {
  if (count > most)
    throw DataError::at(name, "cannot write {} points or elements: the format numbers at most {}", count, most);
}

double negligible_length(const MixedMesh& mesh) {
  if (mesh.points.empty()) return 0;
  return 1e-15 * Box::around(mesh.points).diagonal();
}

}  // namespace hexpipe::formats
