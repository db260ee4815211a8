#pragma once
// Cells of a grid of cubes as keys of a hash map.

#include <array>
#include <cstddef>
#include <cstdint>

namespace hexpipe::tetmesh::geometry {

using GridCell = std::array<std::int64_t, 3>;

// Keys differ for cells within 2^20 of the origin.
constexpr std::uint64_t cell_key(const GridCell& cell) {
  constexpr std::int64_t middle = 1 << 20;
  std::uint64_t key = 0;
  for (const std::int64_t i : cell) key = key << 21 | static_cast<std::uint64_t>(i + middle);
  return key;
}

struct CellKeyHash {
  std::size_t operator()(std::uint64_t key) const {
    key *= 0x9e3779b97f4a7c15u;
    return key ^ key >> 32;
  }
};

}  // namespace hexpipe::tetmesh::geometry
