#pragma once
// The header of a NumPy .npy file, version 1.0: what
// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html specifies, for arrays in C order and
// little-endian numbers.

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/index.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::pipeline {

// 'f' float, 'i' signed, 'u' unsigned, with the number of bytes; as in "<i4".
struct NpyType {
  char kind;
  int bytes;
  bool operator==(const NpyType&) const = default;
};

struct NpyHeader {
  NpyType type{};
  std::vector<std::uint64_t> shape;
};

// The header with magic string, padded to a multiple of 64 bytes.
std::string npy_header(const NpyHeader& header);

// How many bytes the header has, by the first ten bytes of a file; 0 when they are not a .npy header of version 1.
std::size_t npy_header_size(std::string_view first_ten);

// Parses a whole header (as many bytes as npy_header_size says). Throws DataError naming `source`.
NpyHeader parse_npy_header(std::string_view header, std::string_view source);

// How a row of type T is stored in an array: its number type and how many columns it has (0: the array has one
// dimension).
template <class T>
struct NpyRow {
  using Number = T;
  static constexpr std::uint64_t columns = 0;
};
template <class T, std::size_t N>
struct NpyRow<std::array<T, N>> {
  using Number = T;
  static constexpr std::uint64_t columns = N;
};
template <class Kind>
struct NpyRow<Index<Kind>> {
  using Number = std::int32_t;
  static constexpr std::uint64_t columns = 0;
};
template <>
struct NpyRow<Vec3> {
  using Number = double;
  static constexpr std::uint64_t columns = 3;
};

template <class Number>
constexpr NpyType npy_type() {
  if constexpr (std::floating_point<Number>)
    return {'f', sizeof(Number)};
  else if constexpr (std::is_enum_v<Number>)
    return npy_type<std::underlying_type_t<Number>>();
  else
    return {std::signed_integral<Number> ? 'i' : 'u', sizeof(Number)};
}

}  // namespace hexpipe::pipeline
