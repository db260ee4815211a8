#pragma once
// Reads the numbers of a .msh file.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {

// The numbers of a section, as text or as the machine's bytes in the same order.
class MshNumbers {
 public:
  MshNumbers(TextScanner& scanner, bool binary, std::size_t size_bytes)
      : scanner_(scanner), binary_(binary), size_bytes_(size_bytes) {}

  std::int32_t integer(std::string_view what) {
    return binary_ ? bytes<std::int32_t>(what) : scanner_.number<std::int32_t>(what);
  }
  double real(std::string_view what) { return binary_ ? bytes<double>(what) : scanner_.number<double>(what); }
  // A size_t of version 4.1: counts, and numbers of nodes and elements, none of which is negative.
  std::int64_t size(std::string_view what) {
    const std::int64_t number = !binary_           ? scanner_.number<std::int64_t>(what)
                                : size_bytes_ == 4 ? bytes<std::int32_t>(what)
                                                   : bytes<std::int64_t>(what);
    if (number < 0) scanner_.fail_expected(what, std::to_string(number));
    return number;
  }
  // The count of items that follow, each of `numbers` numbers, or `binary_bytes` bytes in binary.
  std::size_t count(std::string_view what, std::size_t numbers, std::size_t binary_bytes) {
    return checked_count(size(what), what, numbers, binary_bytes);
  }
  std::size_t checked_count(std::int64_t announced, std::string_view what, std::size_t numbers,
                            std::size_t binary_bytes) {
    const std::size_t room =
        binary_ ? scanner_.bytes_left() / binary_bytes : (scanner_.bytes_left() + 1) / (2 * numbers);
    if (announced < 0 || static_cast<std::size_t>(announced) > room)
      scanner_.fail(fmt::format("expected {} that the rest of the file can hold, found {}", what, announced));
    return static_cast<std::size_t>(announced);
  }

 private:
  template <class T>
  T bytes(std::string_view what) {
    T number;
    std::memcpy(&number, scanner_.raw(sizeof number, what).data(), sizeof number);
    return number;
  }

  TextScanner& scanner_;
  bool binary_;
  std::size_t size_bytes_;
};

}  // namespace hexpipe::formats
