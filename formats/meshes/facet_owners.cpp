#include "formats/meshes/facet_owners.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/meshes/facet_table.hpp"

namespace hexpipe::formats {
namespace {

template <std::size_t Corners>
class Owners {
 public:
  using Facet = std::array<Vertex, Corners>;

  Owners(const std::vector<Facet>& facets, std::size_t point_count)
      : facets_(facets),
        table_(facets, point_count),
        owners_(facets.size()),
        cells_(facets.size()),
        outward_(facets.size()) {}

  // Considers a facet of a cell, listed counter-clockwise seen from outside.
  void offer(const Facet& facet, const FacetOwner& cell) {
    table_.visit_same(facet, [&](std::size_t i) {
      ++cells_[i];
      if (outward_[i]) return;
      outward_[i] = same_cycle(facets_[i], facet);
      if (outward_[i] || owners_[i].cell == no_index) owners_[i] = cell;
    });
  }

  std::vector<FacetOwner> take() {
    for (std::size_t i = 0; i < owners_.size(); ++i) owners_[i].cells = cells_[i];
    return std::move(owners_);
  }

 private:
  static bool same_cycle(const Facet& a, Facet b) {
    for (std::size_t turn = 0; turn < Corners; ++turn) {
      if (a == b) return true;
      std::rotate(b.begin(), b.begin() + 1, b.end());
    }
    return false;
  }

  const std::vector<Facet>& facets_;
  FacetTable<Corners> table_;
  std::vector<FacetOwner> owners_;
  std::vector<std::int32_t> cells_;
  std::vector<bool> outward_;
};

}  // namespace

FacetOwners find_facet_owners(const MixedMesh& mesh) {
  Owners triangles(mesh.triangles.cells, mesh.points.size());
  Owners quads(mesh.quads.cells, mesh.points.size());
  const auto offer_all = [&](auto topology, const auto& cells) {
    using Topology = decltype(topology);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      FacetOwner owner{static_cast<std::int64_t>(i), Topology::kind, 0};
      for (const LocalTriangle& corners : Topology::triangles) {
        triangles.offer(pick(cells[i], corners), owner);
        ++owner.facet;
      }
      owner.facet = 0;
      for (const LocalQuad& corners : Topology::quads) {
        quads.offer(pick(cells[i], corners), owner);
        ++owner.facet;
      }
    }
  };
  offer_all(HexTopology{}, mesh.hexes.cells);
  offer_all(PrismTopology{}, mesh.prisms.cells);
  offer_all(PyramidTopology{}, mesh.pyramids.cells);
  offer_all(TetTopology{}, mesh.tets.cells);
  return {triangles.take(), quads.take()};
}

}  // namespace hexpipe::formats
