// The seeds and the findings of the fuzzers, and mutations of the seeds, through every reader: tests/fuzz/README.md.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/run/random.hpp"
#include "tests/fuzz/readers.hpp"

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

class FuzzReplay : public testing::TestWithParam<FuzzedReader> {};

TEST_P(FuzzReplay, TakesEverySeed) {
  const auto seeds = files_in(fuzz_directory / "corpus" / GetParam().name);
  EXPECT_FALSE(seeds.empty());
  for (const auto& seed : seeds) EXPECT_NO_THROW(GetParam().read(bytes_of(seed))) << seed;
}

// What they end in is for the tests of the readers to say; here they end.
TEST_P(FuzzReplay, EndsWellOnEveryFinding) {
  for (const auto& finding : files_in(fuzz_directory / "findings" / GetParam().name))
    EXPECT_NO_THROW(accepts(GetParam(), bytes_of(finding))) << finding;
}

TEST_P(FuzzReplay, EndsWellOnSeedsThatAreCutOff) {
  constexpr std::size_t most_cuts = 200;
  for (const auto& seed : files_in(fuzz_directory / "corpus" / GetParam().name)) {
    const std::string bytes = bytes_of(seed);
    const std::size_t step = bytes.size() / most_cuts + 1;
    for (std::size_t length = 0; length < bytes.size(); length += step)
      EXPECT_NO_THROW(accepts(GetParam(), bytes.substr(0, length))) << seed << " cut to " << length;
  }
}

TEST_P(FuzzReplay, EndsWellOnMutatedSeeds) {
  constexpr int mutations = 200;
  for (const auto& seed : files_in(fuzz_directory / "corpus" / GetParam().name)) {
    const std::string bytes = bytes_of(seed);
    for (int i = 0; i < mutations; ++i) {
      Random random(7, static_cast<std::uint64_t>(i));
      EXPECT_NO_THROW(accepts(GetParam(), mutated(bytes, random))) << seed << ", mutation " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, FuzzReplay, testing::ValuesIn(fuzzed_readers().begin(), fuzzed_readers().end()),
                         [](const testing::TestParamInfo<FuzzedReader>& reader) {
                           std::string name = reader.param.name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace hexpipe
