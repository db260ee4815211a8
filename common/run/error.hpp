#pragma once
// How a tool reports bad input (exit 1) and a bad command line (exit 2). tool_main prints both.

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace hexpipe {

// Bad data, or failed I/O.
class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  template <class... Args>
  static DataError at(std::string_view source, fmt::format_string<Args...> text, Args&&... args) {
    return DataError(fmt::format("{}: {}", source, fmt::format(text, std::forward<Args>(args)...)));
  }
};

// Bad data at a line of a text file, counted from 1.
class FormatError : public DataError {
 public:
  FormatError(std::string_view file, long line, std::string_view message)
      : DataError(fmt::format("{}:{}: {}", file, line, message)) {}
};

// A command line that turns out to be wrong only after it was parsed.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hexpipe
