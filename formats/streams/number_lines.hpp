#pragma once
// Lines of whole numbers, for the readers of graphs. They read a text once, byte by byte: these files have hundreds of
// megabytes of short numbers, and finding words first and reading them afterwards takes several times as long.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {

class NumberLines {
 public:
  // The reader skips lines that begin with `comment`. Both texts must outlive it.
  NumberLines(std::string_view text, std::string_view file, char comment)
      : at_(text.data()), begin_(text.data()), end_(text.data() + text.size()), file_(file), comment_(comment) {}

 protected:
  // Goes to the next line that is no comment; false at the end of the text. skip_line or end_line ends a line.
  bool begin_line() {
    while (at_ != end_ && *at_ == comment_) ++line_, skip_line();
    if (at_ == end_) return false;
    ++line_;
    skip_blanks();
    return true;
  }
  void skip_line() {
    const auto* const newline = static_cast<const char*>(std::memchr(at_, '\n', end_ - at_));
    at_ = newline == nullptr ? end_ : newline + 1;
  }
  void end_line(std::string_view what) {
    if (!at_line_end()) fail_expected(what);
    if (at_ != end_) ++at_;
  }
  void go_back_to_begin() {
    at_ = begin_;
    line_ = 0;
  }
  bool at_line_end() const { return at_ == end_ || *at_ == '\n'; }
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }

  std::uint64_t number(std::string_view what) {
    // 18 digits cannot overflow; longer numbers take the careful way.
    const char* const word = at_;
    const char* const fast_end = end_ - at_ > 18 ? at_ + 18 : end_;
    std::uint64_t value = 0;
    while (at_ != fast_end && is_digit(*at_)) value = 10 * value + static_cast<std::uint64_t>(*at_++ - '0');
    if (at_ != end_ && is_digit(*at_)) {
      at_ = word;
      const auto [rest, error] = std::from_chars(at_, end_, value);
      if (error != std::errc{}) fail_expected(fmt::format("{} that fits 64 bits", what));
      at_ = rest;
    }
    if (at_ == word || !(at_line_end() || is_blank(*at_))) {
      at_ = word;
      fail_expected(what);
    }
    skip_blanks();
    return value;
  }
  std::int64_t weight_number(std::string_view what) {
    const char* const word = at_;
    const std::uint64_t value = number(what);
    if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      return static_cast<std::int64_t>(value);
    at_ = word;
    fail_expected(fmt::format("{} that fits 64 bits", what));
  }
  // Any number that is not negative, times `scale`, rounded; without a scale only whole numbers.
  std::int64_t scaled_weight(std::string_view what, std::optional<double> scale) {
    const std::string_view word = peek_word();
    double value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = !word.empty() && error == std::errc{} && rest == word.data() + word.size() && value >= 0;
    if (!scale) {
      if (is_number && word.find_first_not_of("0123456789") != std::string_view::npos)
        fail_expected(fmt::format("{}, a whole number (--weight-scale takes others)", what));
      return weight_number(what);
    }
    constexpr double limit = 0x1p63;
    if (!is_number || !(value * *scale < limit))
      fail_expected(fmt::format("{}, a number that is not negative and below 2^63 when scaled", what));
    take_word();
    return std::llround(value * *scale);
  }
  // Vertices count from 1 in the text, from 0 in the result.
  std::int32_t vertex_number(std::string_view what, std::int32_t vertex_count) {
    const char* const word = at_;
    const std::uint64_t from_one = number(what);
    if (from_one == 0 || from_one > static_cast<std::uint64_t>(vertex_count)) {
      at_ = word;
      fail_expected(fmt::format("{} from 1 to {}", what, vertex_count));
    }
    return static_cast<std::int32_t>(from_one - 1);
  }

  std::string_view peek_word() const {
    const char* word_end = at_;
    while (word_end != end_ && *word_end != '\n' && !is_blank(*word_end)) ++word_end;
    return {at_, static_cast<std::size_t>(word_end - at_)};
  }
  std::string_view take_word() {
    const std::string_view word = peek_word();
    at_ += word.size();
    skip_blanks();
    return word;
  }

  [[noreturn]] void fail(std::string_view message) const { throw FormatError(file_, line_, message); }
  [[noreturn]] void fail_expected(std::string_view what) const {
    const std::string_view word = peek_word();
    const std::string found = !word.empty() ? quote_found(word)
                              : at_ == end_ ? "the end of the file"
                                            : "the end of the line";
    fail(fmt::format("expected {}, found {}", what, found));
  }

  std::string_view file() const { return file_; }
  long line() const { return line_; }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  const char* at_;
  const char* const begin_;
  const char* const end_;
  std::string_view file_;
  char comment_;
  long line_ = 0;
};

}  // namespace hexpipe::formats
