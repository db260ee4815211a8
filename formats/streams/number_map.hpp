#pragma once
// The positions of items that have arbitrary numbers in a file.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::formats {

class NumberMap {
 public:
  NumberMap() = default;
  // The item at position i has number numbers[i], which is not negative. Numbers in sequence take no memory, other
  // numbers that lie close together a table, and the rest a sorted list.
  explicit NumberMap(const std::vector<std::int64_t>& numbers);

  // The position of an item, or no_index.
  std::int32_t find(std::int64_t number) const;
  // A number that two items have, if any.
  std::optional<std::int64_t> repeated() const { return repeated_; }

 private:
  void fill_table(const std::vector<std::int64_t>& numbers, std::uint64_t range);
  void fill_list(const std::vector<std::int64_t>& numbers);

  std::int64_t first_ = 0;
  std::int64_t sequence_ = 0;        // how many of first_, first_ + 1, ... are at positions 0, 1, ...
  std::vector<std::int32_t> table_;  // by number - first_
  std::vector<std::pair<std::int64_t, std::int32_t>> list_;
  std::optional<std::int64_t> repeated_;
};

}  // namespace hexpipe::formats
