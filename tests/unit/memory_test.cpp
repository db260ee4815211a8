#include "common/run/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "common/run/error.hpp"
#include "tests/unit/written_bytes.hpp"

namespace hexpipe {
namespace {

TEST(Memory, IsLeftAndNotEndless) {
  EXPECT_GT(memory_left(), std::uint64_t{1} << 20);
  EXPECT_LT(memory_left(), std::uint64_t{1} << 50);
}

TEST(Memory, OfAControlGroupIsLeftWhereFilesAreCached) {
  const std::string folder = hexpipe::testing::temporary_path("group");
  const auto left = [&](const char* most, const char* current, const char* statistics) {
    std::filesystem::create_directory(folder);
    std::ofstream(folder + "/memory.max") << most;
    std::ofstream(folder + "/memory.current") << current;
    std::ofstream(folder + "/memory.stat") << statistics;
    const std::uint64_t bytes = left_in_control_group(folder);
    std::filesystem::remove_all(folder);
    return bytes;
  };
  const char* const cached = "anon 100\nfile 750\ninactive_file 500\nactive_file 200\nactive_file_not 9\n";
  EXPECT_EQ(left("1000\n", "900\n", cached), 800u);
  EXPECT_EQ(left("1000\n", "900\n", ""), 100u);
  EXPECT_EQ(left("1000\n", "600\n", cached), 1000u) << "more files than the group has now: none of its memory is used";
  EXPECT_EQ(left("100\n", "900\n", cached), 0u);
  EXPECT_EQ(left("max\n", "900\n", cached), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(left_in_control_group("/missing"), std::numeric_limits<std::uint64_t>::max());
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
