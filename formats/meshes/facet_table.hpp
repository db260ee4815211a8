#pragma once
// Finds facets by their vertices, in any order.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::formats {

// Facets in buckets by their lowest vertex, as offsets and members; within a bucket by their vertices in ascending
// order. The facets must outlive the table.
template <std::size_t Corners>
class FacetTable {
 public:
  using Facet = std::array<Vertex, Corners>;

  FacetTable(const std::vector<Facet>& facets, std::size_t point_count)
      : facets_(facets), offsets_(facets.empty() ? 0 : point_count + 2), members_(facets.size()) {
    if (facets_.empty()) return;
    for (const Facet& facet : facets_) ++offsets_[lowest(facet) + 2];
    for (std::size_t i = 2; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
    for (std::size_t i = 0; i < facets_.size(); ++i)
      members_[offsets_[lowest(facets_[i]) + 1]++] = static_cast<std::int32_t>(i);
    for (std::size_t v = 0; v < point_count; ++v) {
      const auto begin = members_.begin() + static_cast<std::ptrdiff_t>(offsets_[v]);
      const auto end = members_.begin() + static_cast<std::ptrdiff_t>(offsets_[v + 1]);
      std::ranges::sort(begin, end, {}, key_of_member());
    }
  }

  // Calls visit(i) for each facet i with the same vertices.
  template <class Visit>
  void visit_same(const Facet& facet, Visit&& visit) const {
    if (facets_.empty()) return;
    const std::size_t vertex = lowest(facet);
    const auto candidates = std::span(members_).subspan(offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]);
    if (candidates.empty()) return;
    const Facet wanted = key(facet);
    const auto key_of = key_of_member();
    for (auto member = std::ranges::lower_bound(candidates, wanted, {}, key_of);
         member != candidates.end() && key_of(*member) == wanted; ++member)
      visit(static_cast<std::size_t>(*member));
  }

 private:
  static std::size_t lowest(const Facet& facet) { return static_cast<std::size_t>(std::ranges::min(facet)); }

  static Facet key(Facet facet) {
    std::ranges::sort(facet);
    return facet;
  }
  auto key_of_member() const {
    return [this](std::int32_t member) { return key(facets_[static_cast<std::size_t>(member)]); };
  }

  const std::vector<Facet>& facets_;
  std::vector<std::size_t> offsets_;
  std::vector<std::int32_t> members_;
};

// The facet of a cell that has these corners.
template <std::size_t Facet, std::size_t Cell>
std::array<Vertex, Facet> pick(const std::array<Vertex, Cell>& cell, const std::array<std::uint8_t, Facet>& corners) {
  std::array<Vertex, Facet> facet;
  for (std::size_t i = 0; i < Facet; ++i) facet[i] = cell[corners[i]];
  return facet;
}

}  // namespace hexpipe::formats
