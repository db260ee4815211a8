// Which bound of a bundle's history, and which optimum, is one of the graph that the bundle has now.

#include "common/mwis/ground/target_weight.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hexpipe {
using namespace mwis::ground;
namespace {

using History = std::vector<nlohmann::ordered_json>;

const nlohmann::ordered_json graph{{"tool", "buildgraph"}};
const nlohmann::ordered_json proven{{"tool", "certify"}, {"bound", 70}};

nlohmann::ordered_json replacing(nlohmann::ordered_json entry, const char* role) {
  entry["replaced"] = nlohmann::ordered_json::array({"solution", role});
  return entry;
}

TEST(BoundIn, IsTheLowestThatCertifyHasProven) {
  EXPECT_EQ(bound_in({graph}), std::nullopt);
  EXPECT_EQ(bound_in({graph, {{"tool", "lns"}, {"bound", 5}}}), std::nullopt);
  EXPECT_EQ(bound_in({graph, proven, {{"tool", "certify"}, {"bound", 80}}, {{"tool", "lns"}}}), 70);
}

TEST(BoundIn, IsForgottenWhereTheGraphIsMadeAnew) {
  for (const char* tool : {"tetmesh", "findhex", "buildgraph"})
    EXPECT_EQ(bound_in({graph, proven, {{"tool", tool}}}), std::nullopt) << tool;
}

TEST(BoundIn, IsForgottenWhereTheGraphCameFromAFile) {
  for (const char* role : {"mesh", "candidates", "graph"}) {
    EXPECT_EQ(bound_in({graph, proven, replacing({{"tool", "initsol"}}, role)}), std::nullopt) << role;
    // The bound of certify holds for the graph that it got.
    EXPECT_EQ(bound_in({graph, proven, replacing({{"tool", "certify"}, {"bound", 90}}, role)}), 90) << role;
  }
  EXPECT_EQ(bound_in({graph, proven, replacing({{"tool", "lns"}}, "solution")}), 70);
}

TEST(BoundIn, TakesAnythingInEntriesOfOthers) {
  for (const nlohmann::ordered_json& replaced : History{"graph", 3, nullptr, {{"graph", 1}}, {1, nullptr}})
    EXPECT_EQ(bound_in({graph, proven, {{"tool", "mine"}, {"replaced", replaced}}}), 70) << replaced;
  EXPECT_EQ(bound_in({nullptr, proven, "text", {{"version", "1"}}}), 70);
  const nlohmann::ordered_json nameless{{"replaced", nlohmann::ordered_json::array({"graph"})}};
  EXPECT_EQ(bound_in({graph, proven, nameless}), std::nullopt);
}

TEST(BoundIn, TakesNoBoundBelowNothing) {
  for (const nlohmann::ordered_json& bound : History{-1, std::numeric_limits<std::uint64_t>::max()})
    EXPECT_EQ(bound_in({graph, proven, {{"tool", "certify"}, {"bound", bound}}}), 70) << bound;
}

const nlohmann::ordered_json solved{{"tool", "initsol"}, {"weight", 50}, {"complete", true}};

TEST(OptimumIn, IsWhatASearchHasProven) {
  EXPECT_EQ(optimum_in({graph}), std::nullopt);
  EXPECT_EQ(optimum_in({graph, {{"tool", "initsol"}, {"weight", 50}, {"complete", false}}}), std::nullopt);
  EXPECT_EQ(optimum_in({graph, solved}), 50);
  EXPECT_EQ(optimum_in({graph, solved, {{"tool", "lns-mpi"}}, proven}), 50);
  EXPECT_EQ(optimum_in({graph, {{"tool", "lns"}, {"weight", 60}, {"complete", true}}}), 60);
}

TEST(OptimumIn, HoldsAsLongAsTheGraphIsKnownToBeTheSame) {
  for (const char* tool : {"tetmesh", "findhex", "buildgraph", "mesh-part", "mine"})
    EXPECT_EQ(optimum_in({graph, solved, {{"tool", tool}}}), std::nullopt) << tool;
  EXPECT_EQ(optimum_in({graph, solved, {{"version", "1"}}}), std::nullopt);
  for (const char* role : {"mesh", "candidates", "graph"}) {
    EXPECT_EQ(optimum_in({graph, solved, replacing({{"tool", "certify"}}, role)}), std::nullopt) << role;
    EXPECT_EQ(optimum_in({graph, solved, replacing(solved, role)}), 50) << role;
  }
  EXPECT_EQ(optimum_in({graph, solved, replacing({{"tool", "certify"}}, "solution")}), 50);
}

TEST(OptimumIn, TakesAnythingInEntriesOfOthers) {
  for (const nlohmann::ordered_json& weight : History{-1, std::numeric_limits<std::uint64_t>::max(), "50", nullptr})
    EXPECT_EQ(optimum_in({graph, {{"tool", "lns"}, {"weight", weight}, {"complete", true}}}), std::nullopt) << weight;
  for (const nlohmann::ordered_json& complete : History{1, "true", nullptr})
    EXPECT_EQ(optimum_in({graph, {{"tool", "lns"}, {"weight", 50}, {"complete", complete}}}), std::nullopt) << complete;
  EXPECT_EQ(optimum_in({nullptr, solved, "text"}), std::nullopt);
  EXPECT_EQ(optimum_in({{{"tool", 3}}, solved}), 50);
}

TEST(TargetWeight, IsTheLeastWhoseGapIsNoMore) {
  EXPECT_EQ(target_weight(0, 1000), 1000);
  EXPECT_EQ(target_weight(0.0005, 1000), 1000);
  EXPECT_EQ(target_weight(0.0015, 1000), 999);
  EXPECT_EQ(target_weight(1, 1000), 0);
}

}  // namespace
}  // namespace hexpipe
