#pragma once
// How a tool says that its input is bad (exit 1) or its command line is (exit 2). tool_main prints both.

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace hexpipe {

// Bad data, or I/O that failed.
class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  template <class... Args>
  static DataError at(std::string_view source, fmt::format_string<Args...> text, Args&&... args) {
    return DataError(fmt::format("{}: {}", source, fmt::format(text, std::forward<Args>(args)...)));
  }
};

// Bad data at a line (counted from 1) of a text file.
class FormatError : public DataError {
 public:
  FormatError(std::string_view file, long line, std::string_view message)
      : DataError(fmt::format("{}:{}: {}", file, line, message)) {}
};

// A command line that cannot be obeyed, found only after it was parsed.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hexpipe
