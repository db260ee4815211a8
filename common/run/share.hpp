#pragma once
// A share of a tool's work, which a cluster's scheduler or make -j can distribute.

#include <cstdint>
#include <string>

namespace hexpipe {

// Share `number` of `count`, counted from 1.
struct Share {
  std::int64_t number = 1, count = 1;

  // The range of this share when `items` items are distributed. Shares follow each other and differ by one item at
  // most.
  std::int64_t begin(std::int64_t items) const { return bound(items, number - 1); }
  std::int64_t end(std::int64_t items) const { return bound(items, number); }

 private:
  std::int64_t bound(std::int64_t items, std::int64_t shares) const {
    return items / count * shares + items % count * shares / count;
  }
};

// Parses "i/k" with 1 <= i <= k < 10^6. Throws UsageError.
Share parse_share(const std::string& text);

}  // namespace hexpipe
