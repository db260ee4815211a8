#include "tools/assemble/hybrid/cell_facets.hpp"

#include <algorithm>

namespace hexpipe::assemble::hybrid {

FacetForm FacetForm::of(std::span<const Vertex> corners) {
  const std::size_t n = corners.size();
  const auto least = static_cast<std::size_t>(std::min_element(corners.begin(), corners.end()) - corners.begin());
  const Vertex next = corners[(least + 1) % n], last = corners[(least + n - 1) % n];
  const Vertex low = std::min(next, last), high = std::max(next, last);
  if (n == 3) return {{corners[least], low, high, no_index}, next < last};
  return {{corners[least], corners[(least + 2) % n], low, high}, next < last};
}

namespace {

template <class Visit>
void for_each_facet(const MixedMesh& mesh, Visit&& visit) {
  for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners, std::int32_t tag) {
    with_topology(kind, [&](auto topology) {
      for (const auto& f : decltype(topology)::triangles)
        visit(FacetForm::of(std::array{corners[f[0]], corners[f[1]], corners[f[2]]}), tag);
      for (const auto& f : decltype(topology)::quads)
        visit(FacetForm::of(std::array{corners[f[0]], corners[f[1]], corners[f[2]], corners[f[3]]}), tag);
    });
  });
}

}  // namespace

CellFacets::CellFacets(const MixedMesh& mesh) : offsets_(mesh.points.size() + 1, 0) {
  // A counting sort by least vertex, then small sorts.
  for_each_facet(mesh, [&](const FacetForm& facet, std::int32_t) { ++offsets_[facet.vertices[0] + 1]; });
  for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
  std::vector<Entry> uses(static_cast<std::size_t>(offsets_.back()));
  std::vector<std::int64_t> next_use(offsets_.begin(), offsets_.end() - 1);
  for_each_facet(mesh, [&](const FacetForm& facet, std::int32_t tag) {
    uses[next_use[facet.vertices[0]]++] = {facet.vertices, 1, false, facet.forward, {tag, tag}, false};
  });
  entries_.reserve(uses.size() / 2);
  std::int64_t begin = 0;
  for (std::size_t v = 0; v + 1 < offsets_.size(); ++v) {
    const std::int64_t end = offsets_[v + 1];
    const std::size_t first_entry = entries_.size();
    offsets_[v] = static_cast<std::int64_t>(first_entry);
    std::stable_sort(uses.begin() + begin, uses.begin() + end,
                     [](const Entry& a, const Entry& b) { return a.vertices < b.vertices; });
    for (std::int64_t i = begin; i < end; ++i) {
      if (entries_.size() == first_entry || entries_.back().vertices != uses[i].vertices) {
        entries_.push_back(uses[i]);
        continue;
      }
      Entry& entry = entries_.back();
      ++entry.uses;
      entry.one_way = entry.one_way || entry.forward == uses[i].forward;
      entry.regions[1] = uses[i].regions[0];
    }
    begin = end;
  }
  offsets_.back() = static_cast<std::int64_t>(entries_.size());
}

CellFacets::Entry* CellFacets::find(const FacetForm& facet) {
  const Vertex v = facet.vertices[0];
  const auto begin = entries_.begin() + offsets_[v], end = entries_.begin() + offsets_[v + 1];
  const auto found = std::lower_bound(begin, end, facet.vertices,
                                      [](const Entry& e, const auto& vertices) { return e.vertices < vertices; });
  return found != end && found->vertices == facet.vertices ? &*found : nullptr;
}

}  // namespace hexpipe::assemble::hybrid
