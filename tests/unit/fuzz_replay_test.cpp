// The seeds and the findings of the fuzzers, and mutations of the seeds, through every reader: tests/fuzz/README.md.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "common/run/random.hpp"
#include "tests/fuzz/tar_members.hpp"
#include "tests/fuzz/targets.hpp"

namespace hexpipe {
namespace {

const std::filesystem::path fuzz_directory = HEXPIPE_TEST_DATA "/../fuzz";

// In the order of their names.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::exists(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

// A few bytes are changed, doubled or dropped.
std::string mutated(std::string bytes, Random& random) {
  const auto changes = 1 + random.below(4);
  for (std::uint64_t i = 0; i < changes && !bytes.empty(); ++i) {
    const std::size_t at = random.below(bytes.size());
    const std::size_t length = std::min<std::size_t>(1 + random.below(16), bytes.size() - at);
    switch (random.below(4)) {
      case 0:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, length));
        break;
      default:
        bytes.erase(at, length);
    }
  }
  return bytes;
}

// A reader takes microseconds, a tool milliseconds.
class FuzzReplay : public ::testing::TestWithParam<FuzzTarget> {
 protected:
  static bool is_tool() { return std::ranges::count(tool_targets(), std::string_view(GetParam().name), &name_of) > 0; }
  static std::string_view name_of(const FuzzTarget& target) { return target.name; }
};

std::string with_other_numbers(const std::string& bytes, Random& random) {
  const auto archive = static_cast<std::size_t>(FuzzReplay::GetParam().archive);
  return bytes.substr(0, archive) + with_changed_numbers(std::string_view(bytes).substr(archive), random);
}

TEST_P(FuzzReplay, TakesEverySeed) {
  const auto seeds = files_in(fuzz_directory / "corpus" / GetParam().name);
  EXPECT_FALSE(seeds.empty());
  for (const auto& seed : seeds) EXPECT_NO_THROW(GetParam().run(bytes_of(seed))) << seed;
}

// Here they only have to end; the tests of the readers judge how.
TEST_P(FuzzReplay, EndsWellOnEveryFinding) {
  for (const auto& finding : files_in(fuzz_directory / "findings" / GetParam().name))
    EXPECT_NO_THROW(accepts(GetParam(), bytes_of(finding))) << finding;
}

TEST_P(FuzzReplay, EndsWellOnSeedsThatAreCutOff) {
  const std::size_t most_cuts = is_tool() ? 30 : 200;
  for (const auto& seed : files_in(fuzz_directory / "corpus" / GetParam().name)) {
    const std::string bytes = bytes_of(seed);
    const std::size_t step = bytes.size() / most_cuts + 1;
    for (std::size_t length = 0; length < bytes.size(); length += step)
      EXPECT_NO_THROW(accepts(GetParam(), bytes.substr(0, length))) << seed << " cut to " << length;
  }
}

TEST_P(FuzzReplay, EndsWellOnMutatedSeeds) {
  const int mutations = is_tool() ? 60 : 200;
  for (const auto& seed : files_in(fuzz_directory / "corpus" / GetParam().name)) {
    const std::string bytes = bytes_of(seed);
    for (int i = 0; i < mutations; ++i) {
      Random random(7, static_cast<std::uint64_t>(i));
      const bool numbers = GetParam().archive >= 0 && i % 2 == 0;
      const std::string changed = numbers ? with_other_numbers(bytes, random) : mutated(bytes, random);
      EXPECT_NO_THROW(accepts(GetParam(), changed)) << seed << ", mutation " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzReplay, ::testing::ValuesIn(fuzz_targets()),
                         [](const ::testing::TestParamInfo<FuzzTarget>& reader) {
                           std::string name = reader.param.name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace hexpipe
