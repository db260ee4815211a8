#include "formats/streams/scalar_bytes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::endian other_order = std::endian::native == std::endian::little ? std::endian::big : std::endian::little;

template <class T>
std::string bytes_of(std::initializer_list<T> numbers, std::endian order = std::endian::native) {
  std::string bytes;
  for (T number : numbers) {
    if (order != std::endian::native) number = swap_bytes(number);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes;
}

TEST(ScalarBytes, ConvertsEveryTypeInEitherOrder) {
  for (const std::endian order : {std::endian::native, other_order}) {
    const auto ints = [&]<class T>(ScalarType type, T) {
      EXPECT_THAT(convert_scalars<std::int32_t>(bytes_of<T>({1, 2, 100}, order), type, order, "w"),
                  ElementsAre(1, 2, 100));
    };
    ints(ScalarType::int8, std::int8_t{});
    ints(ScalarType::uint8, std::uint8_t{});
    ints(ScalarType::int16, std::int16_t{});
    ints(ScalarType::uint16, std::uint16_t{});
    ints(ScalarType::int32, std::int32_t{});
    ints(ScalarType::uint32, std::uint32_t{});
    ints(ScalarType::int64, std::int64_t{});
    ints(ScalarType::uint64, std::uint64_t{});
    ints(ScalarType::float32, float{});
    ints(ScalarType::float64, double{});
    EXPECT_THAT(convert_scalars<double>(bytes_of<float>({0.5F, -2}, order), ScalarType::float32, order, "w"),
                ElementsAre(0.5, -2));
    EXPECT_THAT(convert_scalars<std::int64_t>(bytes_of<std::int8_t>({-1, -128}, order), ScalarType::int8, order, "w"),
                ElementsAre(-1, -128));
  }
}

TEST(ScalarBytes, RefusesWhatHasNoEqual) {
  const auto refuses = [](const std::string& bytes, ScalarType type, const std::string& message) {
    EXPECT_THAT([&] { convert_scalars<std::int32_t>(bytes, type, std::endian::native, "where"); },
                ThrowsMessage<DataError>(HasSubstr("where: " + message)));
  };
  refuses(bytes_of<std::int64_t>({2147483648}), ScalarType::int64, "expected integers of 32 bits, found 2147483648");
  refuses(bytes_of<std::int64_t>({-2147483649}), ScalarType::int64, "expected integers of 32 bits, found -2147483649");
  refuses(bytes_of<std::uint64_t>({~std::uint64_t{0}}), ScalarType::uint64,
          "expected integers of 32 bits, found 184467");
  refuses(bytes_of<double>({0.5}), ScalarType::float64, "expected integers of 32 bits, found 0.5");
  refuses(bytes_of<double>({2147483648.0}), ScalarType::float64, "expected integers of 32 bits, found 2147483648");
  refuses(bytes_of<double>({std::numeric_limits<double>::quiet_NaN()}), ScalarType::float64, "expected integers");
  refuses(bytes_of<float>({std::numeric_limits<float>::infinity()}), ScalarType::float32, "expected integers");
  refuses("12345", ScalarType::int32, "expected items of 4 bytes, found 5 bytes");
}

TEST(ScalarBytes, TakesTheLimits) {
  EXPECT_TRUE(converts_exactly<std::int32_t>(-2147483648.0));
  EXPECT_TRUE(converts_exactly<std::int32_t>(2147483647.0));
  EXPECT_TRUE(converts_exactly<std::int64_t>(-9223372036854775808.0));
  EXPECT_FALSE(converts_exactly<std::int64_t>(9223372036854775808.0));
  EXPECT_FALSE(converts_exactly<std::uint8_t>(-1.0));
  EXPECT_TRUE(converts_exactly<std::uint8_t>(255));
  EXPECT_FALSE(converts_exactly<std::uint8_t>(256));
}

}  // namespace
}  // namespace hexpipe
