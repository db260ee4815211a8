#include "formats/streams/base64.hpp"

#include <cstdint>

namespace hexpipe::formats {

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0;
  };
  for (std::size_t i = 0, to = 0; i < bytes.size(); i += 3, to += 4) {
    const std::uint32_t group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    text[to] = digits[group >> 18];
    text[to + 1] = digits[group >> 12 & 63];
    if (i + 1 < bytes.size()) text[to + 2] = digits[group >> 6 & 63];
    if (i + 2 < bytes.size()) text[to + 3] = digits[group & 63];
  }
  return text;
}

void Base64Writer::end() {
  output_.write(base64(waiting_));
  waiting_.clear();
}

}  // namespace hexpipe::formats
