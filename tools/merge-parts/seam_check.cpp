#include "tools/merge-parts/seam_check.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "common/run/random.hpp"

namespace hexpipe::merge_parts {

std::size_t SeamCheck::Hash::operator()(const Facet& facet) const {
  std::uint64_t h = 0;
  for (const std::int64_t number : facet) h = mix(h ^ static_cast<std::uint64_t>(number));
  return static_cast<std::size_t>(h);
}

SeamCheck::Facet SeamCheck::facet_of(const MeshPiece& piece, const Vertex* corners, std::size_t count) {
  std::array<std::int64_t, 4> number{};
  for (std::size_t i = 0; i < count; ++i) number[i] = piece.point_number[corners[i]];
  const auto least =
      static_cast<std::size_t>(std::min_element(number.begin(), number.begin() + count) - number.begin());
  const std::int64_t next = number[(least + 1) % count], last = number[(least + count - 1) % count];
  return {number[least], count == 4 ? number[(least + 2) % 4] : no_index, std::min(next, last), std::max(next, last)};
}

void SeamCheck::add(const MixedMesh& mesh, const MeshPiece& piece, const std::string& source) {
  std::vector<Facet> facets;
  const auto collect = [&](const auto& block, auto topology) {
    using Topology = decltype(topology);
    for (const auto& cell : block.cells) {
      const auto take = [&](const auto& corners) {
        std::array<Vertex, 4> at{};
        for (std::size_t i = 0; i < corners.size(); ++i) at[i] = cell[corners[i]];
        facets.push_back(facet_of(piece, at.data(), corners.size()));
      };
      for (const auto& corners : Topology::triangles) take(corners);
      for (const auto& corners : Topology::quads) take(corners);
    }
  };
  collect(mesh.hexes, HexTopology{}), collect(mesh.prisms, PrismTopology{});
  collect(mesh.pyramids, PyramidTopology{}), collect(mesh.tets, TetTopology{});
  std::ranges::sort(facets);
  std::vector<std::int64_t> ends;
  for (std::size_t i = 0, next = 0; i < facets.size(); i = next) {
    while (next < facets.size() && facets[next] == facets[i]) ++next;
    if (next - i > 2) throw DataError::at(source, "expected two cells at a facet, found {}", next - i);
    if (next - i == 2) continue;
    Sides& sides = facets_[facets[i]];
    if (++sides.pieces > 2)
      throw DataError::at(source, "expected two pieces at a facet of point {}, found a third", facets[i][0]);
    sides.first = sides.pieces == 1 ? piece.part : sides.first;
    for (const std::int64_t number : facets[i])
      if (number != no_index) ends.push_back(number);
  }
  const auto mark = [&](const auto& block) {
    for (const auto& cell : block.cells)
      if (const auto found = facets_.find(facet_of(piece, cell.data(), cell.size())); found != facets_.end())
        found.value().tagged = true;
  };
  mark(mesh.triangles), mark(mesh.quads);
  std::ranges::sort(ends);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const std::int64_t number = piece.point_number[v];
    if (!std::ranges::binary_search(ends, number)) continue;
    const auto [entry, is_first] = places_.try_emplace(number, mesh.points[v]);
    if (!is_first && entry->second != mesh.points[v])
      throw DataError::at(source, "expected point {} where the other pieces have it, found it elsewhere", number);
  }
}

void SeamCheck::end() const {
  // The least one, so that the message does not depend on the order of the table.
  const Facet* open = nullptr;
  std::int32_t part = 0;
  for (const auto& [facet, sides] : facets_) {
    if (sides.pieces == 2 || sides.tagged || (open != nullptr && *open < facet)) continue;
    open = &facet;
    part = sides.first;
  }
  if (open != nullptr)
    throw DataError(
        fmt::format("expected pieces that fit together, found a facet of piece {} at point {} that no other has", part,
                    (*open)[0]));
}

}  // namespace hexpipe::merge_parts
