#pragma once
// Three things that CLI11 lacks: stricter checks of values (its ranges let NaN pass, and its unsigned integers wrap
// around), a mark for options that stay out of the history, and groups of options that are declared together.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <set>
#include <string>

namespace hexpipe {

// Accepts a number in [low, high].
inline CLI::Validator number_between(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? std::string() : fmt::format("expected a number from {:g} to {:g}, found {}", low, high, text);
      },
      "");
}

// Accepts an unsigned integer of 64 bits in decimal digits.
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

// Accepts a size of memory that CLI11 has turned into bytes. A small number is one whose unit was forgotten.
inline CLI::Validator enough_memory() {
  return CLI::Validator(
      [](const std::string& text) {
        std::uint64_t bytes = 0;
        const bool good = CLI::detail::lexical_cast(text, bytes);
        if (good && bytes >= std::uint64_t{1} << 20 && bytes <= std::uint64_t{1} << 62) return std::string();
        if (good && bytes > 0 && bytes < 1024)
          return fmt::format("expected at least 1M, found {} bytes; {}G are {} gibibytes", text, text, text);
        return fmt::format("expected at least 1M, such as 8G, found {}", text);
      },
      "");
}

// Groups of --help that several tools have. It lists `first` first, then a tool's own groups, then the others.
namespace group {
inline constexpr const char *first = "Options", *input = "Input", *output = "Output", *run = "This run",
                            *experts = "For experts";
}  // namespace group

// Lists the options that are declared from here on in this group.
inline void begin_group(CLI::App& app, const char* name) {
  app.option_defaults()->group(name);
}

// The options of the command line that are marked so; tool_main begins with none. CLI11 has no place for a mark. A
// named check would be one, but asking for it throws where it is missing, and the first exception of a process brings
// 0.3 MiB of tables into its memory.
inline std::set<const CLI::Option*>& options_outside_history() {
  static std::set<const CLI::Option*> options;
  return options;
}

// Marks an option that says where files are or how to run, but does not change the result. It stays out of the history,
// so that the same input and options give the same bytes.
inline CLI::Option* outside_history(CLI::Option* option) {
  options_outside_history().insert(option);
  return option;
}

}  // namespace hexpipe
