#include "formats/meshes/cell_data.hpp"

#include <vector>

#include "formats/meshes/facet_owners.hpp"
#include "formats/meshes/mesh_blocks.hpp"

namespace hexpipe::formats {
namespace {

// Calls visit with the block of a kind of cell.
template <class Visitor>
void with_cell_block(const MixedMesh& mesh, CellKind kind, Visitor&& visit) {
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    if (names.dimension == 3 && names.vtk == static_cast<std::uint8_t>(kind)) visit(block);
  });
}

void add_cells(const MixedMesh& mesh, CellData& data) {
  const bool with_quality = has_quality(mesh);
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    if (names.dimension != 3) return;
    data.region.insert(data.region.end(), block.tags.begin(), block.tags.end());
    data.surface.insert(data.surface.end(), block.size(), 0);
    data.kind.insert(data.kind.end(), block.size(), names.vtk);
    if (with_quality) data.quality.insert(data.quality.end(), block.quality.begin(), block.quality.end());
  });
}

// A facet that belongs to no cell shows region 0, its own kind, and 1 as quality, so that no least value is made up.
template <class Block>
void add_facets(const MixedMesh& mesh, const Block& facets, const std::vector<FacetOwner>& owners,
                std::uint8_t own_kind, CellData& data) {
  const bool with_quality = !data.quality.empty();
  for (std::size_t i = 0; i < facets.size(); ++i) {
    std::int32_t region = 0;
    std::uint8_t kind = own_kind;
    double quality = 1;
    if (const FacetOwner& owner = owners[i]; owner.cell != no_index) {
      kind = static_cast<std::uint8_t>(owner.kind);
      with_cell_block(mesh, owner.kind, [&](const auto& cells) {
        const auto cell = static_cast<std::size_t>(owner.cell);
        region = cells.tags[cell];
        if (with_quality) quality = cells.quality[cell];
      });
    }
    data.region.push_back(region);
    data.surface.push_back(facets.tags[i]);
    data.kind.push_back(kind);
    if (with_quality) data.quality.push_back(quality);
  }
}

}  // namespace

CellData cell_data(const MixedMesh& mesh) {
  CellData data;
  const FacetOwners owners = find_facet_owners(mesh);
  add_cells(mesh, data);
  add_facets(mesh, mesh.triangles, owners.triangles, triangle_names.vtk, data);
  add_facets(mesh, mesh.quads, owners.quads, quad_names.vtk, data);
  return data;
}

}  // namespace hexpipe::formats
