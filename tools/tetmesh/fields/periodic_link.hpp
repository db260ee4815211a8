#pragma once
// How a node with periodic coordinates sees a neighbour, on a surface (K = 2) or in a volume (K = 3).

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/fields/periodic_numbers.hpp"

namespace hexpipe::tetmesh::fields {

// Axis k of the node is axis[k] of the neighbour, turned round where flipped, and `distance[k]` further on.
template <std::size_t K>
struct PeriodicLink {
  std::array<double, K> distance{};  // in sizes
  std::array<Complex, K> turn{};     // by the distances
  std::array<std::uint8_t, K> axis{};
  std::array<bool, K> flipped{};
  std::int32_t neighbour = no_index;
  double weight = 0;

  // To be called when the distances were changed.
  void set_turn() {
    for (std::size_t k = 0; k < K; ++k) turn[k] = number_at(distance[k]);
  }
  // Adds corrections to the distances, none larger than `most`.
  void correct(std::span<const float> corrections, double most) {
    for (std::size_t k = 0; k < K; ++k) distance[k] += std::clamp<double>(corrections[k], -most, most);
  }

  // The same, seen from the neighbour.
  PeriodicLink reversed(std::int32_t from) const {
    PeriodicLink back;
    back.neighbour = from;
    back.weight = weight;
    for (std::size_t k = 0; k < K; ++k) {
      const std::size_t there = axis[k];
      back.axis[there] = static_cast<std::uint8_t>(k);
      back.flipped[there] = flipped[k];
      back.distance[there] = flipped[k] ? distance[k] : -distance[k];
    }
    back.set_turn();
    return back;
  }

  // The neighbour's coordinates, or distances, as those of the node's axis k.
  template <class Numbers>
  double seen_along(const Numbers& there, std::size_t k) const {
    return flipped[k] ? -there[axis[k]] : there[axis[k]];
  }
  // The neighbour's numbers, as the node's own would have to be.
  std::array<Complex, K> seen(const std::array<Complex, K>& there) const {
    std::array<Complex, K> result;
    for (std::size_t k = 0; k < K; ++k) {
      const Complex along = there[axis[k]];
      result[k] = times(flipped[k] ? std::conj(along) : along, turn[k]);
    }
    return result;
  }
  void add_seen(const std::array<Complex, K>& there, std::array<Complex, K>& sum) const {
    const std::array<Complex, K> numbers = seen(there);
    for (std::size_t k = 0; k < K; ++k) sum[k] += weight * numbers[k];
  }
};

}  // namespace hexpipe::tetmesh::fields
