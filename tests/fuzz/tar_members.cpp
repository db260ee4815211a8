#include "tests/fuzz/tar_members.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

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

// Calls visit(header, data, size) for each member that is whole but for its padding.
template <class Visit>
void for_each_member(std::string& archive, Visit&& visit) {
  std::size_t at = 0;
  while (at + block <= archive.size()) {
    char* const header = archive.data() + at;
    if (std::all_of(header, header + block, [](char c) { return c == '\0'; })) break;
    const std::uint64_t bytes = octal(header + size_field, size_length);
    const std::uint64_t blocks = 1 + (bytes + block - 1) / block;
    const bool whole = blocks <= (archive.size() - at) / block;
    visit(header, header + block, whole ? bytes : 0);
    if (!whole) break;
    at += blocks * block;
  }
}

struct Numbers {
  char* data;
  std::size_t count, width;  // of a number, in bytes

  char* at(std::size_t i) const { return data + i * width; }
};

// The numbers in an .npy file; none if it is another kind of file.
Numbers numbers_of(char* data, std::uint64_t bytes) {
  constexpr std::size_t preamble = 10;
  if (bytes < preamble || std::memcmp(data, "\x93NUMPY", 6) != 0) return {data, 0, 1};
  const auto header = static_cast<std::size_t>(static_cast<unsigned char>(data[8]) |
                                               static_cast<unsigned>(static_cast<unsigned char>(data[9])) << 8);
  if (preamble + header > bytes) return {data, 0, 1};
  const std::string_view text(data + preamble, header);
  std::size_t width = 1;
  if (text.find("i4'") != std::string_view::npos) width = 4;
  if (text.find("8'") != std::string_view::npos) width = 8;
  return {data + preamble + header, (bytes - preamble - header) / width, width};
}

void change_a_number(const Numbers& numbers, Random& random) {
  char* const chosen = numbers.at(random.below(numbers.count));
  char* const other = numbers.at(random.below(numbers.count));
  switch (random.below(5)) {
    case 0:
      std::memcpy(chosen, other, numbers.width);
      break;
    case 1:
      std::swap_ranges(chosen, chosen + numbers.width, other);
      break;
    case 2:
      std::memset(chosen, random.below(2) == 0 ? 0 : -1, numbers.width);
      break;
    case 3:
      chosen[random.below(numbers.width)] ^= static_cast<char>(1U << random.below(8));
      break;
    default:
      chosen[0] = static_cast<char>(chosen[0] + (random.below(2) == 0 ? 1 : -1));
  }
}

}  // namespace

std::string with_right_checksums(std::string_view archive) {
  std::string fixed(archive);
  for_each_member(fixed, [](char* header, char*, std::uint64_t) { set_checksum(header); });
  return fixed;
}

std::string with_changed_numbers(std::string_view archive, Random& random) {
  std::string changed(archive);
  std::vector<Numbers> arrays;
  for_each_member(changed, [&](char*, char* data, std::uint64_t bytes) {
    if (const Numbers numbers = numbers_of(data, bytes); numbers.count > 0) arrays.push_back(numbers);
  });
  if (arrays.empty()) return changed;
  const Numbers& numbers = arrays[random.below(arrays.size())];
  const std::uint64_t changes = 1 + random.below(4);
  for (std::uint64_t i = 0; i < changes; ++i) change_a_number(numbers, random);
  return changed;
}

}  // namespace hexpipe
