#include "common/run/part.hpp"

#include <fmt/format.h>

#include <charconv>

#include "common/run/error.hpp"

namespace hexpipe {

Part parse_part(const std::string& text) {
  constexpr std::int64_t too_many = 1000000;
  Part part;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, part.number);
  if (number.ec == std::errc() && number.ptr != end && *number.ptr == '/') {
    const auto count = std::from_chars(number.ptr + 1, end, part.count);
    if (count.ec == std::errc() && count.ptr == end && 1 <= part.number && part.number <= part.count &&
        part.count < too_many)
      return part;
  }
  throw UsageError(fmt::format("--part: expected i/k with 1 <= i <= k, found '{}'", text));
}

}  // namespace hexpipe
