#pragma once
// A share of a tool's work, which a cluster's scheduler or make -j can distribute.

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <string>

#include "common/run/error.hpp"

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
inline Share parse_share(const std::string& text) {
  constexpr std::int64_t too_many = 1000000;
  Share share;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, share.number);
  if (number.ec == std::errc() && number.ptr != end && *number.ptr == '/') {
    const auto count = std::from_chars(number.ptr + 1, end, share.count);
    if (count.ec == std::errc() && count.ptr == end && 1 <= share.number && share.number <= share.count &&
        share.count < too_many)
      return share;
  }
  throw UsageError(fmt::format("--part: expected i/k with 1 <= i <= k, found '{}'", text));
}

}  // namespace hexpipe
