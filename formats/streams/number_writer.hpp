#pragma once
// Writes numbers to an Output: as text, or as the machine's bytes. A double becomes the shortest text that reads back
// as the same number. Formats whose fields have a greatest width get shorter texts: a reader cuts what is longer, and
// reads another number.

#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>

#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// The text of at most `width` characters (8 or more) that reads back nearest to the number; exactly equal if that fits.
// With `needs_point` it has a decimal point; without one, some formats take a number for an integer.
std::string number_within(double number, int width, bool needs_point = false);

// Writes lines of numbers and words, separated by blanks.
class LineWriter {
 public:
  explicit LineWriter(Output& output) : output_(output) {}

  template <class T>
  requires std::is_arithmetic_v<T> LineWriter& operator<<(T number) {
    char text[32];
    const auto result = std::to_chars(text, text + sizeof text, number);
    return *this << std::string_view(text, static_cast<std::size_t>(result.ptr - text));
  }
  LineWriter& operator<<(std::string_view word) {
    if (in_line_) output_.write(" ");
    output_.write(word);
    in_line_ = true;
    return *this;
  }
  void end_line() {
    output_.write("\n");
    in_line_ = false;
  }

 private:
  Output& output_;
  bool in_line_ = false;
};

// `output` is an Output, or something that takes bytes as it does.
template <class Bytes, class T>
void write_bytes(Bytes& output, const T& number) {
  static_assert(std::is_trivially_copyable_v<T>);
  output.write({reinterpret_cast<const char*>(&number), sizeof number});
}

template <class Bytes, class Range>
void write_array_bytes(Bytes& output, const Range& numbers) {
  output.write({reinterpret_cast<const char*>(std::data(numbers)), std::size(numbers) * sizeof *std::data(numbers)});
}

}  // namespace hexpipe::formats
