#pragma once
// Bytes as base64: the letters that stand for them in texts.

#include <cstddef>
#include <string>
#include <string_view>

#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Three bytes are four letters. What is left over is padded, so texts of lengths that are multiples of three can be
// joined.
std::string base64(std::string_view bytes);

// Writes bytes that come one after the other as one run of base64.
class Base64Writer {
 public:
  explicit Base64Writer(Output& output) : output_(output) {}

  void write(std::string_view bytes) {
    while (bytes.size() >= enough - waiting_.size()) {
      const std::size_t taken = enough - waiting_.size();
      waiting_.append(bytes.substr(0, taken));
      bytes.remove_prefix(taken);
      end();
    }
    waiting_.append(bytes);
  }
  // Writes what is left, padded.
  void end();

 private:
  static constexpr std::size_t enough = 3 << 14;  // a multiple of three: nothing is padded before the end

  Output& output_;
  std::string waiting_;
};

}  // namespace hexpipe::formats
