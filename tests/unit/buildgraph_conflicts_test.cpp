#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "common/conflicts/conflicts.hpp"
#include "common/conflicts/sorted_set.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "common/run/random.hpp"
#include "random_graphs.hpp"
#include "tools/buildgraph/buildgraph.hpp"
#include "tools/buildgraph/report.hpp"

namespace hexpipe {
using namespace buildgraph;
using namespace conflicts;
using namespace graph;
namespace {

using testing::add_candidate;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

// Tets are numbered by cell unless a test says otherwise.
bool conflict(CellKind a, std::vector<Vertex> corners_a, CellKind b, std::vector<Vertex> corners_b,
              std::vector<std::int32_t> tets_a = {0}, std::vector<std::int32_t> tets_b = {1}) {
  Candidates pair;
  add_candidate(pair, a, std::move(corners_a), tets_a);
  add_candidate(pair, b, std::move(corners_b), tets_b);
  EXPECT_EQ(in_conflict(pair, 0, 1), in_conflict(pair, 1, 0));
  const ConflictGraph graph = conflict_graph(pair, {}, "test");
  EXPECT_EQ(graph.edge_count() == 1, in_conflict(pair, 0, 1));
  return in_conflict(pair, 0, 1);
}

constexpr CellKind hex = CellKind::hex, prism = CellKind::prism, pyramid = CellKind::pyramid;
const std::vector<Vertex> first_hex{0, 1, 2, 3, 4, 5, 6, 7};

TEST(ConflictRules, NoneOrOneSharedVertex) {
  EXPECT_FALSE(conflict(hex, first_hex, hex, {10, 11, 12, 13, 14, 15, 16, 17}));
  EXPECT_FALSE(conflict(hex, first_hex, hex, {6, 11, 12, 13, 14, 15, 16, 17}));
}

TEST(ConflictRules, TwoSharedVerticesAreAnEdgeOfBoth) {
  EXPECT_FALSE(conflict(hex, first_hex, hex, {2, 6, 12, 13, 14, 15, 16, 17}));
  EXPECT_TRUE(conflict(hex, first_hex, hex, {1, 6, 12, 13, 14, 15, 16, 17})) << "a diagonal of a quad of the first";
  EXPECT_TRUE(conflict(hex, first_hex, hex, {0, 6, 12, 13, 14, 15, 16, 17})) << "a diagonal through the first";
  EXPECT_TRUE(conflict(hex, first_hex, hex, {2, 11, 6, 13, 14, 15, 16, 17})) << "a diagonal of the second";
  EXPECT_FALSE(conflict(hex, first_hex, prism, {11, 12, 2, 14, 15, 6}));
  EXPECT_TRUE(conflict(hex, first_hex, prism, {11, 12, 2, 14, 6, 15}));
  EXPECT_FALSE(conflict(hex, first_hex, pyramid, {11, 2, 13, 14, 6}));
  EXPECT_TRUE(conflict(hex, first_hex, pyramid, {2, 11, 6, 14, 13}));
}

TEST(ConflictRules, ThreeSharedVerticesAreATriangleOfBoth) {
  EXPECT_FALSE(conflict(prism, {0, 1, 2, 3, 4, 5}, prism, {2, 1, 0, 13, 14, 15}));
  EXPECT_FALSE(conflict(prism, {0, 1, 2, 3, 4, 5}, pyramid, {0, 1, 12, 13, 2}));
  EXPECT_FALSE(conflict(pyramid, {0, 1, 2, 3, 4}, pyramid, {14, 15, 1, 0, 4}));
  EXPECT_TRUE(conflict(prism, {0, 1, 2, 3, 4, 5}, pyramid, {0, 1, 2, 13, 14})) << "half of the pyramid's quad";
  EXPECT_TRUE(conflict(prism, {0, 1, 2, 3, 4, 5}, prism, {0, 1, 13, 14, 2, 15})) << "half of the second's quad";
  EXPECT_TRUE(conflict(hex, first_hex, hex, {0, 1, 2, 13, 14, 15, 16, 17})) << "never with a hex";
  EXPECT_TRUE(conflict(hex, first_hex, prism, {0, 1, 2, 13, 14, 15})) << "never with a hex";
}

TEST(ConflictRules, FourSharedVerticesAreAQuadOfBothInTheSameOrder) {
  EXPECT_FALSE(conflict(hex, first_hex, hex, {4, 5, 6, 7, 14, 15, 16, 17}));
  EXPECT_FALSE(conflict(hex, first_hex, hex, {6, 5, 14, 15, 7, 4, 16, 17}));
  EXPECT_FALSE(conflict(hex, first_hex, pyramid, {4, 5, 6, 7, 14}));
  EXPECT_FALSE(conflict(prism, {0, 1, 2, 3, 4, 5}, hex, {0, 1, 4, 3, 14, 15, 16, 17}));
  EXPECT_TRUE(conflict(hex, first_hex, hex, {4, 6, 5, 7, 14, 15, 16, 17})) << "another order";
  EXPECT_TRUE(conflict(hex, first_hex, pyramid, {4, 6, 5, 7, 14})) << "another order";
  EXPECT_TRUE(conflict(hex, first_hex, hex, {0, 1, 6, 7, 14, 15, 16, 17})) << "a quad of the second only";
  EXPECT_TRUE(conflict(hex, first_hex, pyramid, {4, 5, 6, 17, 7})) << "the apex takes part";
  EXPECT_TRUE(conflict(hex, first_hex, hex, {0, 11, 2, 13, 14, 5, 16, 7}));
}

TEST(ConflictRules, MoreSharedVerticesNeverAgree) {
  EXPECT_TRUE(conflict(hex, first_hex, hex, {4, 5, 6, 7, 0, 15, 16, 17}));
  EXPECT_TRUE(conflict(hex, first_hex, pyramid, {4, 5, 6, 7, 0}));
  EXPECT_TRUE(conflict(hex, first_hex, hex, {1, 5, 6, 2, 0, 4, 7, 3}));
}

TEST(ConflictRules, ASharedInteriorTetIsAConflict) {
  EXPECT_TRUE(conflict(hex, first_hex, hex, {10, 11, 12, 13, 14, 15, 16, 17}, {1, 3, 5}, {2, 3, 9}));
  EXPECT_FALSE(conflict(hex, first_hex, hex, {10, 11, 12, 13, 14, 15, 16, 17}, {1, 3, 5}, {0, 2, 4, 6}));
  EXPECT_TRUE(conflict(hex, first_hex, hex, {4, 5, 6, 7, 14, 15, 16, 17}, {1, 3, 5}, {5}));
}

TEST(ConflictRules, BoundaryTetsTakeNoPart) {
  Candidates pair;
  add_candidate(pair, hex, first_hex, {0});
  add_candidate(pair, hex, {4, 5, 6, 7, 14, 15, 16, 17}, {1});
  pair.boundary_tets = {TetIndex(2), TetIndex(2)};
  pair.boundary_tet_offsets = {0, 1, 2};
  EXPECT_FALSE(in_conflict(pair, 0, 1));
  EXPECT_EQ(conflict_graph(pair, {}, "test").edge_count(), 0);
}

// Cells thrown together: everything that may be shared is.
Candidates random_candidates(std::size_t count, std::int32_t vertices, std::int32_t tets, Random& random) {
  Candidates candidates;
  std::vector<Vertex> all(vertices);
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    constexpr CellKind kinds[] = {hex, prism, pyramid};
    const CellKind kind = kinds[random.below(3)];
    random.shuffle(std::span(all));
    std::vector<std::int32_t> own;
    for (std::int32_t t = 0; t < tets; ++t)
      if (random.below(tets) < 2) own.push_back(t);
    // Half of the cells take over a facet, or most of another cell.
    std::vector<Vertex> corners(all.begin(), all.begin() + corner_count(kind));
    if (i > 0 && random.below(2) == 0) {
      const auto other = candidates.corners_of(random.below(i));
      const std::size_t shared = random.below(std::min(corners.size(), other.size()) + 1);
      std::copy_n(other.begin(), shared, corners.begin());
      std::sort(corners.begin() + shared, corners.end());
      for (std::size_t c = shared, next = 0; c < corners.size(); ++next) {
        if (std::find(corners.begin(), corners.begin() + c, all[next]) == corners.begin() + c) corners[c++] = all[next];
      }
    }
    add_candidate(candidates, kind, corners, own);
  }
  return candidates;
}

TEST(Buildgraph, AgreesWithAllPairs) {
  Random random(1);
  std::int64_t edges = 0, pairs = 0;
  for (int n = 0; n < 200; ++n) {
    const auto count = 2 + random.below(60);
    const Candidates candidates =
        random_candidates(count, static_cast<std::int32_t>(12 + random.below(60)), 200, random);
    validate(candidates, "test");
    const ConflictGraph graph = conflict_graph(candidates, {}, "test");
    validate(graph, "test");
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        ASSERT_EQ(graph.has_edge(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)),
                  i != j && in_conflict(candidates, i, j))
            << "seed 1, case " << n << ", candidates " << i << " " << j;
    edges += graph.edge_count();
    pairs += static_cast<std::int64_t>(count * (count - 1) / 2);
  }
  EXPECT_GT(edges, pairs / 20);
  EXPECT_LT(edges, pairs * 19 / 20);
}

TEST(Buildgraph, IsTheSameForAnyThreads) {
  Random random(2);
  const Candidates candidates = random_candidates(3000, 900, 3000, random);
  auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return conflict_graph(candidates, {}, "test");
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST(Buildgraph, NeedsNoMemoryForNumbersThatAreNotThere) {
  Random random(3);
  Candidates candidates = random_candidates(40, 30, 100, random);
  const ConflictGraph graph = conflict_graph(candidates, {}, "test");
  EXPECT_FALSE(with_dense_ids(candidates));
  for (auto& row : candidates.vertices)
    for (Vertex& v : row)
      if (v >= 0) v = std::numeric_limits<Vertex>::max() - 1000 + v;
  for (TetIndex& tet : candidates.tets) tet = TetIndex(std::numeric_limits<std::int32_t>::max() - 1000 + tet);
  const auto dense = with_dense_ids(candidates);
  ASSERT_TRUE(dense);
  validate(*dense, "test");
  EXPECT_EQ(conflict_graph(candidates, {}, "test"), graph);
}

TEST(Buildgraph, OfNothingIsEmpty) {
  const ConflictGraph graph = conflict_graph({}, {}, "test");
  EXPECT_EQ(graph, ConflictGraph{});
  EXPECT_EQ(summarize({.product = {.graph = graph}, .dominated = 0}).density, 0);
}

TEST(Weights, AreRoundedAfterScaling) {
  Candidates c;
  add_candidate(c, hex, first_hex, {0});
  c.quality[0] = 0.12345678;
  c.volume[0] = 3;
  EXPECT_THAT(weights_of(c, WeightKind::quality, 1e6, "test"), ElementsAre(123457));
  EXPECT_THAT(weights_of(c, WeightKind::quality, 10, "test"), ElementsAre(1));
  EXPECT_THAT(weights_of(c, WeightKind::volume, 1e6, "test"), ElementsAre(3000000));
  EXPECT_THAT(weights_of(c, WeightKind::count, 1e6, "test"), ElementsAre(1000000));
  EXPECT_THAT(weights_of(c, WeightKind::quality_volume, 1e6, "test"), ElementsAre(370370));
  EXPECT_THAT(weights_of(c, WeightKind::mild_quality_volume, 1e6, "test"), ElementsAre(1601680));
}

TEST(Weights, ThatDoNotFitAreErrors) {
  Candidates c;
  add_candidate(c, hex, first_hex, {0});
  add_candidate(c, hex, first_hex, {1});
  c.volume = {5e12, 5e12};
  EXPECT_THAT(weights_of(c, WeightKind::volume, 9e5, "test"), ElementsAre(4500000000000000000, 4500000000000000000));
  EXPECT_THAT([&] { weights_of(c, WeightKind::volume, 1e6, "test"); },
              ThrowsMessage<DataError>(HasSubstr("up to candidate 2: a smaller --weight-scale helps")));
  EXPECT_THAT([&] { weights_of(c, WeightKind::volume, 1e7, "test"); },
              ThrowsMessage<DataError>(HasSubstr("candidate 1")));
  EXPECT_THAT([&] { weights_of(c, WeightKind::volume, 1e300, "test"); },
              ThrowsMessage<DataError>(HasSubstr("candidate 1")));
  c.volume = {1, -1};
  EXPECT_THAT([&] { weights_of(c, WeightKind::volume, 1, "x.cand"); },
              ThrowsMessage<DataError>("x.cand: expected no negative weight, found -1 for candidate 2"));
  EXPECT_THAT([&] { weights_of(c, WeightKind::volume, 1e6, "x.cand"); },
              ThrowsMessage<DataError>("x.cand: expected no negative weight, found -1 for candidate 2"))
      << "as it is in the file";
}

TEST(Report, WarnsOfWeightsThatVanish) {
  Candidates c;
  add_candidate(c, hex, first_hex, {0});
  c.volume = {1e-9};
  pipeline::StageData data;
  data.candidates = c;
  BuildgraphOptions options{{WeightKind::volume, 1e6}};
  EXPECT_THAT(warnings_about(summarize(buildgraph::buildgraph(data, options, {}))),
              ElementsAre(HasSubstr("1 of 1 weights")));
  options.conflicts.weight_scale = 1e12;
  EXPECT_THAT(warnings_about(summarize(buildgraph::buildgraph(data, options, {}))), IsEmpty());
}

TEST(SortedSet, ListsInOrderAndEmptiesItself) {
  Random random(4);
  SortedSet set(20000);
  for (int n = 0; n < 100; ++n) {
    std::vector<std::int32_t> expected, found;
    const auto count = random.below(50);
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto item = static_cast<std::int32_t>(random.below(20000));
      set.insert(item);
      set.insert(item);
      if (random.below(4) == 0)
        set.erase(item);
      else
        expected.push_back(item);
    }
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    set.drain([&](std::int32_t item) { found.push_back(item); });
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace hexpipe
