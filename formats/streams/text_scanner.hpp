#pragma once
// Reads words and numbers of a text and knows their line, for the readers of ASCII formats.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "common/mesh/vec3.hpp"
#include "common/run/error.hpp"

namespace hexpipe::formats {

class TextScanner {
 public:
  // Skips from the character `comment` to the end of its line; '\0': the format has no comments. Both texts must
  // outlive the scanner. `first_line`: the number of the text's first line in its file.
  TextScanner(std::string_view text, std::string_view file, char comment = '\0', long first_line = 1)
      : text_(text), file_(file), comment_(comment), line_(first_line) {}

  long line() const { return line_; }
  std::size_t position() const { return at_; }
  // True when only white space and comments are left.
  bool at_end();
  // True when only blanks and a comment are left on this line.
  bool at_line_end() const {
    std::size_t i = at_;
    while (i < text_.size() && (text_[i] == ' ' || text_[i] == '\t' || text_[i] == '\r')) ++i;
    return i == text_.size() || text_[i] == '\n' || (comment_ != '\0' && text_[i] == comment_);
  }
  // The next word without taking it; empty at the end.
  std::string_view peek_word();
  // The next word; an error "expected <what>, found end of file" at the end.
  std::string_view word(std::string_view what);
  // The next word as a number that fits T; an error "expected <what>, found '...'" otherwise. A leading '+' is allowed;
  // infinities and NaN are errors.
  template <class T>
  T number(std::string_view what);
  // The next three words as coordinates, which may stand on several lines.
  Vec3 point();
  // The next word must be this one, ASCII case ignored.
  void expect(std::string_view word);
  // The rest of the line, without its end and a comment; goes to the next line.
  std::string_view rest_of_line();
  // Takes `bytes` raw bytes from here; an error when fewer are left.
  std::string_view raw(std::size_t bytes, std::string_view what);
  // Goes past the next place where `word` stands; an error when there is none.
  void skip_past(std::string_view word);
  std::size_t bytes_left() const { return text_.size() - at_; }

  // Reads a count, and checks that the rest of the text can hold as many items of at least `bytes_each` bytes, before
  // anything is allocated for them.
  std::size_t count(std::string_view what, std::size_t bytes_each);

  [[noreturn]] void fail(std::string_view message) const { throw FormatError(file_, line_, message); }
  // `found` is a word of the text; empty: the end of the text.
  [[noreturn]] void fail_expected(std::string_view expected, std::string_view found) const;

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  bool ends_word(char c) const { return is_space(c) || (c == comment_ && comment_ != '\0'); }
  void skip_space();
  void skip_comment();
  // The next word as a double where from_chars gives up because the magnitude is too small; otherwise an error.
  double underflowing_number(std::string_view what);

  std::string_view text_, file_;
  char comment_;
  std::size_t at_ = 0;
  long line_ = 1;
};

bool equal_ignoring_case(std::string_view a, std::string_view b);
// The text in capitals; only ASCII letters change.
std::string capitals(std::string_view text);
// Without blanks, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view text);

// For ASCII, whatever the locale.
constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// A word of a file as messages show it: in quotes, cut after 40 characters, '?' in place of anything but printable
// ASCII; "end of file" when it is empty.
std::string quote_found(std::string_view word);

// The text without the byte order mark that an editor may put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

// Lines may end in CR alone, as on the oldest Macs: then each becomes LF. Other texts and binary files stay.
void unify_line_ends(std::string& text);

// Throws DataError unless a text ends with the end of a line. Where nothing else marks the end of a file, the last
// number may be cut off.
void expect_last_line_end(std::string_view text, std::string_view file);

inline void TextScanner::skip_space() {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '\n') {
      ++line_;
    } else if (!is_space(c)) {
      if (c != comment_ || comment_ == '\0') return;
      skip_comment();
      if (at_ == text_.size()) return;
      ++line_;
    }
  }
}

template <class T>
T TextScanner::number(std::string_view what) {
  static_assert(std::is_arithmetic_v<T>);
  skip_space();
  const char* begin = text_.data() + at_;
  const char* const end = text_.data() + text_.size();
  if (end - begin > 1 && *begin == '+' && begin[1] != '-') ++begin;
  T value{};
  const auto [stop, error] = std::from_chars(begin, end, value);
  const bool whole_word = stop == end || ends_word(*stop);
  if constexpr (std::is_floating_point_v<T>) {
    if (error == std::errc::result_out_of_range && whole_word) return static_cast<T>(underflowing_number(what));
    if (error != std::errc{} || !whole_word || !std::isfinite(value)) fail_expected(what, peek_word());
  } else {
    if (error != std::errc{} || !whole_word) fail_expected(what, peek_word());
  }
  at_ = static_cast<std::size_t>(stop - text_.data());
  return value;
}

}  // namespace hexpipe::formats
