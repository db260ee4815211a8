#pragma once
// Converts arrays of numbers from the type that a binary file has to the type that we want.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe::formats {

enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

// Calls visit(T{}) for the C++ type of a scalar type.
template <class Visitor>
decltype(auto) with_scalar_type(ScalarType type, Visitor&& visit) {
  switch (type) {
    case ScalarType::int8:
      return visit(std::int8_t{});
    case ScalarType::uint8:
      return visit(std::uint8_t{});
    case ScalarType::int16:
      return visit(std::int16_t{});
    case ScalarType::uint16:
      return visit(std::uint16_t{});
    case ScalarType::int32:
      return visit(std::int32_t{});
    case ScalarType::uint32:
      return visit(std::uint32_t{});
    case ScalarType::int64:
      return visit(std::int64_t{});
    case ScalarType::uint64:
      return visit(std::uint64_t{});
    case ScalarType::float32:
      return visit(float{});
    case ScalarType::float64:
      break;
  }
  return visit(double{});
}

inline std::size_t size_of(ScalarType type) {
  return with_scalar_type(type, [](auto number) { return sizeof number; });
}

template <class T>
T swap_bytes(T number) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &number, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  std::memcpy(&number, bytes, sizeof(T));
  return number;
}

// True when `number` has the same value in To: an integer that fits, or a finite float, which is whole if To is an
// integer.
template <class To, class From>
bool converts_exactly(From number) {
  if constexpr (std::is_floating_point_v<From> && std::is_integral_v<To>) {
    // The bounds are powers of two (or zero), so they are exact as doubles.
    constexpr double low = static_cast<double>(std::numeric_limits<To>::min());
    const double high = std::ldexp(1.0, std::numeric_limits<To>::digits);
    return number >= low && number < high && std::trunc(number) == number;
  } else if constexpr (std::is_floating_point_v<To>) {
    return true;
  } else {
    return std::in_range<To>(number);
  }
}

// `bytes` holds numbers of `type` in the byte order `order`; `where` begins messages. Throws DataError when To does not
// have the value of a number, or the bytes are not a whole number of items. Every number converts to double.
template <class To>
std::vector<To> convert_scalars(std::string_view bytes, ScalarType type, std::endian order, std::string_view where) {
  return with_scalar_type(type, [&]<class From>(From) {
    if (bytes.size() % sizeof(From) != 0)
      throw DataError::at(where, "expected items of {} bytes, found {} bytes", sizeof(From), bytes.size());
    std::vector<To> numbers(bytes.size() / sizeof(From));
    const bool swapped = order != std::endian::native;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      From number;
      std::memcpy(&number, bytes.data() + i * sizeof(From), sizeof(From));
      if (swapped) number = swap_bytes(number);
      if (!converts_exactly<To>(number))
        throw DataError::at(where, "expected integers of {} bits, found {}", 8 * sizeof(To), +number);
      numbers[i] = static_cast<To>(+number);
    }
    return numbers;
  });
}

}  // namespace hexpipe::formats
