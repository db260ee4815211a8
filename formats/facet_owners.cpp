#include "formats/facet_owners.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace hexpipe {
namespace {

// Facets in buckets by their lowest vertex, as offsets and members; within a bucket by their vertices in ascending
// order.
template <std::size_t Corners>
class FacetTable {
 public:
  using Facet = std::array<Vertex, Corners>;

  FacetTable(const std::vector<Facet>& facets, std::size_t point_count)
      : facets_(facets),
        offsets_(facets.empty() ? 0 : point_count + 2),
        members_(facets.size()),
        owners_(facets.size()),
        outward_(facets.size()) {
    if (facets_.empty()) return;
    for (const Facet& facet : facets_) ++offsets_[lowest(facet) + 2];
    for (std::size_t i = 2; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
    for (std::size_t i = 0; i < facets_.size(); ++i)
      members_[offsets_[lowest(facets_[i]) + 1]++] = static_cast<std::int32_t>(i);
    for (std::size_t v = 0; v < point_count; ++v) std::ranges::sort(bucket(v), {}, key_of_member());
  }

  // Tells of a facet of a cell, listed counter-clockwise seen from outside.
  void offer(const Facet& facet, const FacetOwner& cell) {
    if (facets_.empty()) return;
    const std::span<std::int32_t> candidates = bucket(lowest(facet));
    if (candidates.empty()) return;
    const Facet wanted = key(facet);
    const auto key_of = key_of_member();
    for (auto member = std::ranges::lower_bound(candidates, wanted, {}, key_of);
         member != candidates.end() && key_of(*member) == wanted; ++member) {
      const auto i = static_cast<std::size_t>(*member);
      if (outward_[i]) continue;
      outward_[i] = same_cycle(facets_[i], facet);
      if (outward_[i] || owners_[i].cell < 0) owners_[i] = cell;
    }
  }

  std::vector<FacetOwner> take_owners() { return std::move(owners_); }

 private:
  static std::size_t lowest(const Facet& facet) { return static_cast<std::size_t>(std::ranges::min(facet)); }

  static Facet key(Facet facet) {
    std::ranges::sort(facet);
    return facet;
  }
  auto key_of_member() const {
    return [this](std::int32_t member) { return key(facets_[static_cast<std::size_t>(member)]); };
  }
  std::span<std::int32_t> bucket(std::size_t vertex) {
    return std::span(members_).subspan(offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]);
  }

  static bool same_cycle(const Facet& a, Facet b) {
    for (std::size_t turn = 0; turn < Corners; ++turn) {
      if (a == b) return true;
      std::rotate(b.begin(), b.begin() + 1, b.end());
    }
    return false;
  }

  const std::vector<Facet>& facets_;
  std::vector<std::size_t> offsets_;
  std::vector<std::int32_t> members_;
  std::vector<FacetOwner> owners_;
  std::vector<bool> outward_;
};

template <std::size_t Facet, std::size_t Cell>
std::array<Vertex, Facet> pick(const std::array<Vertex, Cell>& cell, const std::array<std::uint8_t, Facet>& corners) {
  std::array<Vertex, Facet> facet;
  for (std::size_t i = 0; i < Facet; ++i) facet[i] = cell[corners[i]];
  return facet;
}

}  // namespace

FacetOwners find_facet_owners(const MixedMesh& mesh) {
  FacetTable triangles(mesh.triangles.cells, mesh.points.size());
  FacetTable quads(mesh.quads.cells, mesh.points.size());
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
  return {triangles.take_owners(), quads.take_owners()};
}

}  // namespace hexpipe
