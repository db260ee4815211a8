#include "common/run/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "common/run/error.hpp"

namespace hexpipe {
namespace {

TEST(Memory, IsLeftAndNotEndless) {
  EXPECT_GT(memory_left(), std::uint64_t{1} << 20);
  EXPECT_LT(memory_left(), std::uint64_t{1} << 50);
}

TEST(Memory, RefusesWhatIsTooLarge) {
  EXPECT_NO_THROW(expect_memory(1000, 8, "numbers"));
  try {
    expect_memory(std::uint64_t{1} << 62, 8, "numbers");  // more bytes than 64 bits can count
    FAIL() << "accepted";
  } catch (const DataError& error) {
    EXPECT_THAT(std::string(error.what()),
                ::testing::MatchesRegex("numbers: expected 34359738368.0 GiB of memory, found .* left"));
  }
}

}  // namespace
}  // namespace hexpipe
