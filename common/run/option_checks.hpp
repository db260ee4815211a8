#pragma once
// Checks of option values that CLI11 lacks: its own ranges let NaN pass, and its unsigned integers wrap around.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <string>

namespace hexpipe {

// A number in [low, high].
inline CLI::Validator number_between(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? std::string() : fmt::format("expected a number from {:g} to {:g}, found {}", low, high, text);
      },
      "");
}

// An unsigned integer of 64 bits in decimal digits.
inline CLI::Validator whole_number_of_64_bits() {
  return CLI::Validator(
      [](const std::string& text) {
        std::uint64_t value = 0;
        const char* const last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, value);
        const bool good = error == std::errc() && end == last;
        return good ? std::string() : fmt::format("expected a whole number from 0 to {}, found {}", UINT64_MAX, text);
      },
      "");
}

}  // namespace hexpipe
