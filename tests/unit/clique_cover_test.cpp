#include "common/graph/clique_cover.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "common/mesh/candidates.hpp"
#include "common/run/error.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
namespace {

using hexpipe::testing::make_graph;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

bool is_maximal(std::span<const std::int32_t> clique, const ConflictGraph& graph) {
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    if (std::ranges::all_of(clique, [&](std::int32_t u) { return graph.has_edge(u, v); })) return false;
  return true;
}

TEST(CliqueCover, BeginsWithTheCliquesThatAreKnownGrown) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const ConflictGraph graph =
        hexpipe::testing::random_clique_graph(static_cast<std::int32_t>(2 + random.below(30)), 30, 1000, random);
    const CliqueCover whole = greedy_edge_clique_cover(graph);
    CliqueCover known;
    for (std::int64_t c = 0; c < whole.size(); ++c) {
      const auto clique = whole.clique(c);
      if (clique.size() > 1) known.add({clique.begin(), clique.begin() + 2});
    }
    const CliqueCover cover = greedy_edge_clique_cover(graph, known), grown = maximal_cliques(graph, known);
    EXPECT_NO_THROW(validate(cover, graph, "test")) << "graph " << i;
    ASSERT_LE(grown.size(), cover.size());
    for (std::int64_t c = 0; c < cover.size(); ++c) EXPECT_TRUE(is_maximal(cover.clique(c), graph)) << "graph " << i;
    EXPECT_TRUE(std::equal(grown.members.begin(), grown.members.end(), cover.members.begin())) << "graph " << i;
  }
}

TEST(CliqueCover, LeavesOutWhatIsNoCliqueOrKnownAlready) {
  const ConflictGraph path_and_triangle = make_graph({1, 1, 1, 1, 1, 1}, {{0, 1}, {1, 2}, {3, 4}, {4, 5}, {3, 5}});
  CliqueCover known;
  known.add({0, 2});
  known.add({3, 4});
  known.add({3, 5});
  const CliqueCover grown = maximal_cliques(path_and_triangle, known);
  ASSERT_EQ(grown.size(), 1);
  EXPECT_THAT(grown.members, ElementsAre(3, 4, 5));
}

TEST(CliqueCover, ThatIsNoneIsAnError) {
  const ConflictGraph graph = make_graph({1, 1, 1, 1}, {{0, 1}, {1, 2}, {0, 2}, {2, 3}});
  const auto of = [](std::vector<std::int64_t> offsets, std::vector<std::int32_t> members) {
    return CliqueCover{std::move(offsets), std::move(members)};
  };
  const auto message = [&](const CliqueCover& cover) -> std::string {
    try {
      validate(cover, graph, "x.tar");
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(of({0, 3, 5}, {0, 1, 2, 2, 3})), "");
  EXPECT_THAT(message(of({0, 3}, {0, 1, 2})), HasSubstr("x.tar: expected every edge in a clique, found 2 of 3"));
  EXPECT_THAT(message(of({0, 4}, {0, 1, 2, 3})), HasSubstr("expected cliques, found 0 and 3 together"));
  EXPECT_THAT(message(of({0, 3, 5}, {0, 2, 1, 2, 3})), HasSubstr("ascending vertices below 4 in clique 0, found 1"));
  EXPECT_THAT(message(of({0, 3, 5}, {0, 1, 2, 3, 4})), HasSubstr("found 4 after 3"));
  EXPECT_THAT(message(of({0, 3, 5}, {-1, 1, 2, 2, 3})), HasSubstr("found -1"));
  EXPECT_THAT(message(of({0, 3, 6}, {0, 1, 2, 2, 3})), HasSubstr("offsets of cliques"));
  EXPECT_THAT(message(of({0, 4, 3, 5}, {0, 1, 2, 2, 3})), HasSubstr("offsets of cliques"));
  EXPECT_THAT(message(of({1, 3, 5}, {0, 1, 2, 2, 3})), HasSubstr("offsets of cliques"));
  EXPECT_THAT(message(of({}, {})), HasSubstr("offsets of cliques"));
}

TEST(TetCliques, AreTheCandidatesOfEachTet) {
  Candidates candidates;
  for (const std::vector<std::int32_t>& tets : {std::vector<std::int32_t>{0, 1}, {1, 2}, {1, 7}, {2, 7}, {5}}) {
    candidates.vertices.emplace_back();
    candidates.kind.push_back(CellKind::hex);
    for (const std::int32_t t : tets) candidates.tets.emplace_back(t);
    candidates.tet_offsets.push_back(static_cast<std::int64_t>(candidates.tets.size()));
  }
  const CliqueCover cliques = cliques_of_tets(candidates);
  EXPECT_THAT(cliques.offsets, ElementsAre(0, 3, 5, 7));
  EXPECT_THAT(cliques.members, ElementsAre(0, 1, 2, 1, 3, 2, 3));
  constexpr std::int32_t to_the_last = std::numeric_limits<std::int32_t>::max() - 7;
  for (TetIndex& tet : candidates.tets) tet = TetIndex(tet + to_the_last);
  EXPECT_EQ(cliques_of_tets(candidates).members, cliques.members) << "numbers that take no memory";
  EXPECT_EQ(cliques_of_tets({}).size(), 0);
}

}  // namespace
}  // namespace hexpipe
