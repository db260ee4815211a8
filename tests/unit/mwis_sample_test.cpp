#include "common/mwis/reduce/sample.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "random_graphs.hpp"

namespace hexpipe {
using namespace mwis::reduce;
namespace {

using hexpipe::testing::no_deadline;

TEST(Sample, TellsWhetherReductionsDecideEnough) {
  Random random(1);
  const graph::ConflictGraph sparse = hexpipe::testing::random_graph(3000, 1e-3, 100, random);
  const Sample of_sparse = reduce_sample(sparse, 2, {}, no_deadline);
  EXPECT_GT(of_sparse.complete, 1000);
  EXPECT_TRUE(of_sparse.decides_enough());
  const graph::ConflictGraph dense = hexpipe::testing::random_graph(2000, 0.1, 100, random);
  const Sample of_dense = reduce_sample(dense, 2, {}, no_deadline);
  EXPECT_EQ(of_dense.complete, 2000);
  EXPECT_FALSE(of_dense.decides_enough());
}

// What is decided there is for reasons that the rest of the graph, in other blocks, may not agree with.
TEST(Sample, DecidesNothingAroundIncompleteVertices) {
  Random random(2);
  const graph::ConflictGraph graph = hexpipe::testing::random_graph(1000, 1e-3, 100, random);
  const Sample sample = reduce_sample(graph, 1, std::vector<char>(1000, 1), no_deadline);
  EXPECT_EQ(sample.complete, 0);
  EXPECT_EQ(sample.decided, 0);
}

TEST(Sample, IsForLargeGraphsOfManyConflicts) {
  EXPECT_TRUE(needs_sample(1000000, 60000000));
  EXPECT_FALSE(needs_sample(1000000, 10000000)) << "sparse";
  EXPECT_FALSE(needs_sample(60000, 6000000)) << "small";
}

}  // namespace
}  // namespace hexpipe
