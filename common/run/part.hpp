#pragma once
// A share of a tool's work, which a cluster's scheduler or make -j can distribute.

#include <cstdint>
#include <string>

namespace hexpipe {

// Part `number` of `count`, counted from 1.
struct Part {
  std::int64_t number = 1, count = 1;

  // This part's range when `items` items are shared out. Parts follow each other and differ by one item at most.
  std::int64_t begin(std::int64_t items) const { return bound(items, number - 1); }
  std::int64_t end(std::int64_t items) const { return bound(items, number); }

 private:
  std::int64_t bound(std::int64_t items, std::int64_t parts) const {
    return items / count * parts + items % count * parts / count;
  }
};

// Parses "i/k" with 1 <= i <= k < 10^6. Throws UsageError.
Part parse_part(const std::string& text);

}  // namespace hexpipe
