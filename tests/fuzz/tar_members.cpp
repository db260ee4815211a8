#include "tests/fuzz/tar_members.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace hexpipe {
namespace {

// POSIX ustar.
constexpr std::size_t block = 512;
constexpr std::size_t size_field = 124, size_length = 12;
constexpr std::size_t checksum_field = 148, checksum_length = 8;

void set_checksum(char* header) {
  std::memset(header + checksum_field, ' ', checksum_length);
  unsigned sum = 0;
  for (std::size_t i = 0; i < block; ++i) sum += static_cast<unsigned char>(header[i]);
  std::snprintf(header + checksum_field, checksum_length, "%06o", sum);
  header[checksum_field + checksum_length - 1] = ' ';
}

std::uint64_t octal(const char* digits, std::size_t length) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < length && digits[i] >= '0' && digits[i] <= '7'; ++i)
    value = 8 * value + static_cast<std::uint64_t>(digits[i] - '0');
  return value;
}

}  // namespace

std::string with_right_checksums(std::string_view archive) {
  std::string fixed(archive);
  std::size_t at = 0;
  while (at + block <= fixed.size()) {
    char* const header = fixed.data() + at;
    if (std::all_of(header, header + block, [](char c) { return c == '\0'; })) break;
    set_checksum(header);
    const std::uint64_t bytes = octal(header + size_field, size_length);
    const std::uint64_t blocks = 1 + (bytes + block - 1) / block;
    if (blocks > (fixed.size() - at) / block) break;
    at += blocks * block;
  }
  return fixed;
}

}  // namespace hexpipe
