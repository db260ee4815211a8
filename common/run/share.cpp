#include "common/run/share.hpp"

#include <fmt/format.h>

#include <charconv>

#include "common/run/error.hpp"

namespace hexpipe {

Share parse_share(const std::string& text) {
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
