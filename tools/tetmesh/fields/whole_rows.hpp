#pragma once
// Whole numbers of rows between features that stand apart.
//
// Coordinates are held along features and on faces, because these are rows of the lattice. Between two of them lie as
// many rows as the distances say, which need not be a whole number: around a hole that is half a row off the grid of
// the sides, periodic numbers agree with the sides here and with the hole there, and rows end in between. So held
// coordinates that are whole numbers apart make a set, and each set is moved so that whole numbers lie between the
// sets, too; what lies between them stretches. Mixed-integer quadrangulation (D. Bommes, H. Zimmer, L. Kobbelt, 2009)
// rounds such numbers one by one and solves for all coordinates after each.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/tetmesh/fields/periodic_link.hpp"
#include "tools/tetmesh/fields/periodic_numbers.hpp"

namespace hexpipe::tetmesh::fields {

// The links of nodes with K periodic coordinates: links[offsets[i]] to links[offsets[i + 1]] are those of node i. They
// go both ways.
template <std::size_t K>
struct LinkedNodes {
  std::span<const std::int64_t> offsets;  // nodes + 1, so one at least
  std::span<const PeriodicLink<K>> links;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const PeriodicLink<K>> links_of(std::size_t node) const {
    return links.subspan(static_cast<std::size_t>(offsets[node]),
                         static_cast<std::size_t>(offsets[node + 1] - offsets[node]));
  }
};

// A coordinate of each node, up to whole numbers, where it is held.
template <std::size_t K>
using HeldCoordinates = std::vector<std::array<std::optional<double>, K>>;

// What to add to the coordinates of all nodes, so that those that are held are whole numbers apart, in the unit of the
// distances of links. Empty where nothing is to be gained.
template <std::size_t K>
std::vector<std::array<double, K>> whole_row_shifts(const LinkedNodes<K>& nodes, const HeldCoordinates<K>& held);

// What lies between two sets of held coordinates.
struct SetGap {
  std::int32_t first, second;  // their numbers
  bool flipped;                // their coordinates run against each other
  double weight;               // of the links from what is nearer to one set to what is nearer to the other
  Complex offset;              // exp(2 pi i offset) of the second as seen from the first, times the weight
  double length;               // of the ways between them, in sizes, times the weight
};

// By how much to move the coordinates of each set, so that the offsets between them become whole, and as little as
// possible. Where what lies between two sets would stretch by more than about a third, rows end as before. Sets are
// given by how many coordinates they have. Weights of gaps are above 0.
std::vector<double> whole_shifts(std::span<const std::int32_t> set_sizes, std::span<const SetGap> gaps);

}  // namespace hexpipe::tetmesh::fields
