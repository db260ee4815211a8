#include "tools/assemble/gap/front.hpp"

#include <numeric>

namespace hexpipe::assemble::gap {

bool Front::has(SmallFacet facet) const {
  if (facet.is_quad()) return quads_ > 0 && std::ranges::find(facets(), facet) != facets().end();
  const std::size_t number = facet.number_of_triangle();
  return (has_triangle_[number / 64] >> number % 64 & 1) != 0;
}

void Front::add(SmallFacet facet) {
  facets_[size_++] = facet;
  if (facet.is_quad())
    ++quads_;
  else
    has_triangle_[facet.number_of_triangle() / 64] |= std::uint64_t{1} << facet.number_of_triangle() % 64;
}

void Front::remove(SmallFacet facet) {
  const auto end = facets_.begin() + static_cast<std::ptrdiff_t>(size_);
  const auto at = std::find(facets_.begin(), end, facet);
  std::copy(at + 1, end, at);
  --size_;
  if (facet.is_quad())
    --quads_;
  else
    has_triangle_[facet.number_of_triangle() / 64] &= ~(std::uint64_t{1} << facet.number_of_triangle() % 64);
}

void Front::put(const SmallCell& cell) {
  for_facets(cell, [&](SmallFacet facet) {
    if (has(facet))
      remove(facet);
    else
      add(facet.reversed());
  });
}

std::size_t Front::most_bodies() const {
  std::array<std::uint8_t, 64> parent;
  std::iota(parent.begin(), parent.end(), std::uint8_t{0});
  const auto root = [&](std::uint8_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  // By edge: how many facets have it, and the first two.
  std::array<std::uint8_t, 256> count{}, first, second;
  std::array<std::uint8_t, 256> edges;
  std::size_t edge_count = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    const SmallFacet facet = facets_[i];
    for (std::size_t k = 0; k < facet.size(); ++k) {
      const Corner a = facet[k], b = facet[k + 1 == facet.size() ? 0 : k + 1];
      const auto edge = static_cast<std::uint8_t>(std::min(a, b) << 4 | std::max(a, b));
      if (count[edge]++ == 0) edges[edge_count++] = edge, first[edge] = static_cast<std::uint8_t>(i);
      second[edge] = static_cast<std::uint8_t>(i);
    }
  }
  std::size_t bodies = size_;
  for (const std::uint8_t edge : std::span(edges).first(edge_count)) {
    if (count[edge] != 2) continue;
    const std::uint8_t a = root(first[edge]), b = root(second[edge]);
    if (a == b) continue;
    parent[a] = b;
    --bodies;
  }
  return bodies;
}

std::size_t Front::least_by_facets() const {
  const std::size_t closed_at_most = quads_ > 0 ? 5 : 4;  // by one cell
  return (size_ + closed_at_most - 1) / closed_at_most;
}

std::size_t Front::least_in_bodies(std::size_t bodies) const {
  const std::size_t halves = size_ - quads_;
  return halves > 2 * bodies ? (halves - 2 * bodies + 1) / 2 : 0;
}

std::size_t Front::least_cells() const {
  return std::max(least_by_facets(), least_in_bodies(most_bodies()));
}

bool Front::may_cost_less(double cost, double most) const {
  const auto is_below = [&](std::size_t cells) { return cost + static_cast<double>(cells) < most; };
  return is_below(least_by_facets()) && (is_below(least_in_bodies(1)) || is_below(least_in_bodies(most_bodies())));
}

}  // namespace hexpipe::assemble::gap
