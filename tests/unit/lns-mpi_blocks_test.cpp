#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tools/lns-mpi/block_memory.hpp"
#include "tools/lns-mpi/regions.hpp"

namespace hexpipe::lns_mpi {

void PrintTo(const BlockMemory::Place& place, std::ostream* out) {
  *out << place.key << ": " << place.tries[0] << ' ' << place.tries[1] << ' ' << place.tries[2] << ", " << place.size;
}

static bool operator==(const BlockMemory::Place& a, const BlockMemory::Place& b) {
  return a.key == b.key && a.tries == b.tries && a.size == b.size;
}

namespace {

using ::testing::ElementsAre;
using Place = BlockMemory::Place;
constexpr auto blocks = Searchers::Kind::blocks, ranks = Searchers::Kind::ranks;

TEST(BlockMemory, ForgetsTheTriesOfSomePlacesButNotTheirSize) {
  BlockMemory memory({{10, {1, 2, 3}, 100}, {20, {4, 5, 6}, 200}, {30, {7, 8, 9}, 300}}, {});
  memory.forget_tries(std::array<std::uint64_t, 4>{5, 20, 25, 40});
  EXPECT_THAT(memory.places(),
              ElementsAre(Place{10, {1, 2, 3}, 100}, Place{20, {0, 0, 0}, 200}, Place{30, {7, 8, 9}, 300}));
}

TEST(BlockMemory, TakesThePlacesOfOthersInTheirOrder) {
  BlockMemory memory({{20, {1, 2, 3}, 100}}, {});
  const std::array others{BlockMemory({{10, {4, 5, 6}, 200}, {20, {9, 9, 9}, 900}}, {}), BlockMemory(),
                          BlockMemory({{15, {7, 8, 9}, 300}}, {})};
  memory.join(others);
  EXPECT_THAT(memory.places(),
              ElementsAre(Place{10, {4, 5, 6}, 200}, Place{15, {7, 8, 9}, 300}, Place{20, {1, 2, 3}, 100}));
}

// Borders move to and fro, so a place that is another's in this round comes back.
TEST(BlockMemory, KeepsThePlacesOutsideOfARegion) {
  BlockMemory memory({{10, {1, 2, 3}, 100}, {20, {4, 5, 6}, 200}, {30, {7, 8, 9}, 300}}, {});
  Region region;
  region.vertices = {1, 2};
  const std::array<std::uint64_t, 3> keys{10, 15, 20};
  mwis::local_search::LnsMemory learnt;
  learnt.places = {{0, {2, 2, 2}, 50}};
  memory.remember(learnt, region, keys);
  EXPECT_THAT(memory.places(),
              ElementsAre(Place{10, {1, 2, 3}, 100}, Place{15, {2, 2, 2}, 50}, Place{30, {7, 8, 9}, 300}));
}

// 0 - 1 - 2 | 3 - 4 - 5 in two blocks of one rank.
LocalGraph path() {
  LocalGraph local;
  local.owners = BlockOwners(2, 1);
  local.overlap = 1;
  local.keys = {0, 1, 2, 3, 4, 5};
  local.block = {0, 0, 0, 1, 1, 1};
  local.chosen.assign(6, 0);
  local.decided.assign(6, 0);
  local.graph.weights.assign(6, 1);
  for (std::int32_t v = 0; v < 6; ++v) {
    if (v > 0) local.graph.neighbours.push_back(v - 1);
    if (v < 5) local.graph.neighbours.push_back(v + 1);
    local.graph.offsets.push_back(std::ssize(local.graph.neighbours));
  }
  local.near = {{1, 2}, {1, 1}, {0, 1}, {0, 2}};
  local.near_offsets = {0, 0, 1, 2, 3, 4, 4};
  return local;
}

TEST(Regions, OfBlocksLeaveWhatIsBetweenThemAsItIs) {
  const LocalGraph local = path();
  Regions regions(local, Searchers(local.owners, blocks), 1, 0);
  const std::size_t sizes = regions.extract(0).vertices.size() + regions.extract(1).vertices.size();
  EXPECT_EQ(sizes, 5u);
}

TEST(Regions, OfRanksHaveTheirBlocksAsOne) {
  const LocalGraph local = path();
  Regions regions(local, Searchers(local.owners, ranks), 1, 0);
  const Region region = regions.extract(0);
  EXPECT_THAT(region.vertices, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(region.graph.edge_count(), 5);
}

// Otherwise the same block is the smaller one, and the same vertices stay as they are, several times in a row.
TEST(Regions, GiveBackInTheNextRoundWhatTheyTook) {
  const LocalGraph local = path();
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    Regions first(local, Searchers(local.owners, blocks), seed, 6),
        second(local, Searchers(local.owners, blocks), seed, 7);
    for (const std::int32_t block : {0, 1})
      EXPECT_EQ(first.extract(block).vertices.size() + second.extract(block).vertices.size(), 5u) << "seed " << seed;
  }
}

}  // namespace
}  // namespace hexpipe::lns_mpi
