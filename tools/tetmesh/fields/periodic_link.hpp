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
  std::array<std::uint8_t, K> axis{};
  std::array<bool, K> flipped{};
  std::int32_t neighbour = no_index;
  double weight = 0;

  // Adds corrections to the distances, none larger than `most`.
  void correct(std::span<const float> corrections, double most) {
    for (std::size_t k = 0; k < K; ++k) distance[k] += std::clamp<double>(corrections[k], -most, most);
  }

  // Follows coordinates of both ends that have been moved by these.
  void move(const std::array<double, K>& here, const std::array<double, K>& there) {
    for (std::size_t k = 0; k < K; ++k) distance[k] += here[k] - seen_along(there, k);
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
    return back;
  }

  // The neighbour's coordinates, or distances, as those of the node's axis k.
  template <class Numbers>
  double seen_along(const Numbers& there, std::size_t k) const {
    return flipped[k] ? -there[axis[k]] : there[axis[k]];
  }
};

// The weighted sum of what a node sees.
template <std::size_t K>
struct SeenSum {
  SeenSum() { parts.fill(ComplexParts::Zero()); }
  std::array<Complex, K> numbers() const {
    std::array<Complex, K> result;
    for (std::size_t k = 0; k < K; ++k) result[k] = complex_of(parts[k]);
    return result;
  }

  std::array<ComplexParts, K> parts;
};

// How a node sees the numbers of a neighbour. Solvers look at all links in each of their steps, and their time is that
// of reading them from memory, so it has nothing else, and for K = 3 it is one line of the cache.
template <std::size_t K>
class LinkView {
 public:
  LinkView() = default;
  explicit LinkView(const PeriodicLink<K>& link) : weight_(link.weight), neighbour_(link.neighbour), axis_(link.axis) {
    for (std::size_t k = 0; k < K; ++k) {
      turn_[k] = number_at(link.distance[k]);
      if (link.flipped[k]) flipped_ |= static_cast<std::uint8_t>(1 << k);
    }
  }

  std::int32_t neighbour() const { return neighbour_; }
  const Complex& turn(std::size_t k) const { return turn_[k]; }
  // The neighbour's numbers, as the node's own would have to be.
  std::array<Complex, K> seen(const std::array<Complex, K>& there) const {
    std::array<Complex, K> result;
    for (std::size_t k = 0; k < K; ++k) result[k] = complex_of(seen(there, k));
    return result;
  }
  void add_seen(const std::array<Complex, K>& there, SeenSum<K>& sum) const {
    for (std::size_t k = 0; k < K; ++k) sum.parts[k] += weight_ * seen(there, k);
  }

 private:
  ComplexParts seen(const std::array<Complex, K>& there, std::size_t k) const {
    // Axes are flipped without any order, so a branch would be guessed wrong every other time.
    static constexpr std::array<double, 2> senses{1, -1};
    const ComplexParts along = parts_of(there[axis_[k]]), turn = parts_of(turn_[k]);
    return along[0] * turn + (senses[flipped_ >> k & 1] * along[1]) * ComplexParts(-turn[1], turn[0]);
  }

  std::array<Complex, K> turn_{};  // by the distances
  double weight_ = 0;
  std::int32_t neighbour_ = no_index;
  std::array<std::uint8_t, K> axis_{};
  std::uint8_t flipped_ = 0;  // a bit for each axis
};

}  // namespace hexpipe::tetmesh::fields
