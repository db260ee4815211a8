#pragma once
// Words and numbers of a text with their line, for the readers of ASCII formats.

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/run/error.hpp"

namespace hexpipe {

class TextScanner {
 public:
  // `comment`: from this character to the end of the line is skipped; '\0' for none. Both texts must outlive the scanner.
  TextScanner(std::string_view text, std::string_view file, char comment = '\0')
      : text_(text), file_(file), comment_(comment) {}

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
  // The next word as a number that fits T; an error "expected <what>, found '...'" otherwise.
  template <class T>
  T number(std::string_view what);
  // The next word must be this one, ASCII case ignored.
  void expect(std::string_view word);
  // The rest of the line, without its end; goes to the next line.
  std::string_view rest_of_line();
  // Takes `bytes` raw bytes from here; an error when fewer are left.
  std::string_view raw(std::size_t bytes, std::string_view what);
  std::size_t bytes_left() const { return text_.size() - at_; }

  // A count announced by the text, checked against what the rest of the text can hold at `bytes_each` or more an item,
  // before anything is allocated for it.
  std::size_t count(std::string_view what, std::size_t bytes_each);

  [[noreturn]] void fail(std::string_view message) const { throw FormatError(file_, line_, message); }
  [[noreturn]] void fail_expected(std::string_view expected, std::string_view found) const;

 private:
  void skip_space();

  std::string_view text_, file_;
  char comment_;
  std::size_t at_ = 0;
  long line_ = 1;
};

bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace hexpipe
