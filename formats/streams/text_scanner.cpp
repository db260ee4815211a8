#include "formats/streams/text_scanner.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace hexpipe::formats {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

std::string capitals(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return result;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

std::string quote_found(std::string_view word) {
  if (word.empty()) return "end of file";
  constexpr std::size_t longest = 40;
  std::string shown(word.substr(0, longest));
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + shown + (word.size() > longest ? "...'" : "'");
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

void unify_line_ends(std::string& text) {
  constexpr std::string_view line_feed_or_binary{"\n\0", 2};
  if (text.find_first_of(line_feed_or_binary) == std::string::npos) std::ranges::replace(text, '\r', '\n');
}

void expect_last_line_end(std::string_view text, std::string_view file) {
  if (!text.ends_with('\n'))
    throw DataError::at(file, "expected the last line to have an end, found none; is the file cut off?");
}

void TextScanner::skip_comment() {
  at_ = std::min(text_.find('\n', at_), text_.size());
}

bool TextScanner::at_end() {
  skip_space();
  return at_ == text_.size();
}

std::string_view TextScanner::peek_word() {
  skip_space();
  std::size_t end = at_;
  while (end < text_.size() && !ends_word(text_[end])) ++end;
  return text_.substr(at_, end - at_);
}

std::string_view TextScanner::word(std::string_view what) {
  const std::string_view found = peek_word();
  if (found.empty()) fail_expected(what, found);
  at_ += found.size();
  return found;
}

void TextScanner::expect(std::string_view expected) {
  const std::string_view found = peek_word();
  if (!equal_ignoring_case(found, expected)) fail_expected(expected, found);
  at_ += found.size();
}

std::string_view TextScanner::rest_of_line() {
  const std::size_t newline = std::min(text_.find('\n', at_), text_.size());
  std::string_view rest = text_.substr(at_, newline - at_);
  at_ = std::min(newline + 1, text_.size());
  line_ += newline < text_.size();
  if (comment_ != '\0') rest = rest.substr(0, rest.find(comment_));
  if (rest.ends_with('\r')) rest.remove_suffix(1);
  return rest;
}

std::string_view TextScanner::raw(std::size_t bytes, std::string_view what) {
  if (bytes > bytes_left()) fail(fmt::format("expected {} bytes of {}, found {}", bytes, what, bytes_left()));
  const std::string_view taken = text_.substr(at_, bytes);
  at_ += bytes;
  line_ += std::ranges::count(taken, '\n');
  return taken;
}

void TextScanner::skip_past(std::string_view word) {
  const std::size_t found = text_.find(word, at_);
  if (found == std::string_view::npos) fail_expected(word, "");
  raw(found + word.size() - at_, word);
}

std::size_t TextScanner::count(std::string_view what, std::size_t bytes_each) {
  const auto announced = number<std::uint64_t>(what);
  // The last item needs no separator after it.
  if (announced > (bytes_left() + 1) / bytes_each)
    fail(fmt::format("expected {} that the rest of the file can hold, found {}", what, announced));
  return announced;
}

Vec3 TextScanner::point() {
  const auto x = number<double>("a coordinate");
  const auto y = number<double>("a coordinate");
  const auto z = number<double>("a coordinate");
  return {x, y, z};
}

void TextScanner::fail_expected(std::string_view expected, std::string_view found) const {
  fail(fmt::format("expected {}, found {}", expected, quote_found(found)));
}

double TextScanner::underflowing_number(std::string_view what) {
  const std::string found(peek_word());
  const double value = std::strtod(found.c_str(), nullptr);
  if (!std::isfinite(value)) fail_expected(what, found);
  at_ += found.size();
  return value;
}

}  // namespace hexpipe::formats
