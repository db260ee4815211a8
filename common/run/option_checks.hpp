#pragma once
// Checks of option values that CLI11 lacks: its own ranges let NaN pass.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
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

}  // namespace hexpipe
