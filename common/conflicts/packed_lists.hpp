#pragma once
// Ascending lists of small integers, one after another, stored as differences of one to five bytes. Neighbours in a
// conflict graph are close to each other, so a list takes about a third of its usual memory.

#include <cstdint>
#include <vector>

namespace hexpipe::conflicts {

class PackedLists {
 public:
  // Items ascend within a list and are 0 or more.
  void add(std::int32_t item) {
    put(static_cast<std::uint32_t>(item) - last_);
    last_ = static_cast<std::uint32_t>(item);
  }
  void end_list() {
    put(0);
    last_ = before_first;
  }

  // Calls visit_item(list, item) for all items of all lists, in order; lists are counted from `first_list`.
  template <class Visit>
  void for_each(std::int64_t first_list, Visit&& visit_item) const {
    std::int64_t list = first_list;
    std::uint32_t last = before_first;
    for (const std::uint8_t* at = bytes_.data(); at != bytes_.data() + bytes_.size();) {
      std::uint32_t difference = *at & 127u;
      for (int shift = 7; (*at++ & 128u) != 0; shift += 7) difference |= (*at & 127u) << shift;
      if (difference == 0) {
        ++list;
        last = before_first;
      } else {
        last += difference;
        visit_item(list, static_cast<std::int32_t>(last));
      }
    }
  }

  void shrink_to_fit() { bytes_.shrink_to_fit(); }
  std::size_t bytes() const { return bytes_.size(); }

 private:
  static constexpr std::uint32_t before_first = ~std::uint32_t{0};  // -1, because unsigned numbers wrap around

  // Seven bits per byte, lowest first; the eighth bit says that more follow. A difference is never 0, so a 0 ends a
  // list.
  void put(std::uint32_t difference) {
    for (; difference > 127; difference >>= 7) bytes_.push_back(static_cast<std::uint8_t>(difference | 128u));
    bytes_.push_back(static_cast<std::uint8_t>(difference));
  }

  std::vector<std::uint8_t> bytes_;
  std::uint32_t last_ = before_first;
};

}  // namespace hexpipe::conflicts
