#include "formats/choice/graph_reading.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace formats;
using namespace graph;
namespace {

using hexpipe::testing::make_graph;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ConflictGraph graph_of(const std::string& text, const GraphReading& reading = {}, LeftOut* left_out = nullptr) {
  Input input = Input::from_memory(text, "test.graph");
  return read_graph(input, reading, left_out);
}

void expect_refused(const std::string& text, const std::string& message, const GraphReading& reading = {}) {
  EXPECT_THAT([&] { graph_of(text, reading); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("test.graph"), HasSubstr(message))))
      << text;
}

const ConflictGraph path_of_three = make_graph({1, 1, 1}, {{0, 1}, {1, 2}});
const std::string market = "%%MatrixMarket matrix coordinate ";

TEST(GraphReading, TellsFormatsByTheirFirstBytes) {
  EXPECT_EQ(graph_of("3 2\n2\n1 3\n2\n"), path_of_three);
  EXPECT_EQ(graph_of("p edge 3 2\ne 1 2\ne 2 3\n"), path_of_three);
  EXPECT_EQ(graph_of("# Nodes: 3\n1 2\n2 3\n"), path_of_three);
  EXPECT_EQ(graph_of(market + "pattern symmetric\n3 3 2\n2 1\n3 2\n"), path_of_three);
  EXPECT_EQ(graph_of("1 2\n2 3\n", {.format = GraphFormat::edges}), path_of_three);
  expect_refused("1 2\n2 3\n", "expected", {.format = GraphFormat::matrix_market});
}

TEST(GraphReading, TakesEdgeListsFromZeroOrOne) {
  const GraphReading edges{.format = GraphFormat::edges};
  EXPECT_EQ(graph_of("0 1\n1 2\n", edges), path_of_three);
  EXPECT_EQ(graph_of("1 2\n2 3\n", edges), path_of_three);
  EXPECT_EQ(graph_of("% konect\n2\t1 5.5 1234\n# more\n\n2 3\r\n3 2\n", edges), path_of_three);
  EXPECT_EQ(graph_of("2 4\n", edges), make_graph({1, 1, 1, 1}, {{1, 3}}));
  LeftOut left_out;
  EXPECT_EQ(graph_of("0 0\n0 1\n1 2\n", edges, &left_out), path_of_three);
  EXPECT_EQ(left_out.loops, 1);
  expect_refused("", "expected lines of two vertices", edges);
  expect_refused("1 2\n3\n", ":2: expected a vertex, found the end of the line", edges);
  expect_refused("1 2\nx 3\n", ":2: expected a vertex, found 'x'", edges);
  expect_refused("1 2\n2 3000000000\n", ":2: expected vertices below 2^31 - 1, found 3000000000", edges);
  expect_refused("1 2\n2 2000000000\n", "expected at most 1000004 vertices in a list of 2 edges", edges);
  expect_refused("1 2\n2 3", "expected the last line to have an end", edges);
}

TEST(GraphReading, TakesMatricesOfAllKinds) {
  EXPECT_EQ(graph_of(market + "real general\n% a comment\n3 3 5\n1 1 4.5\n1 2 -1\n2 1 -1\n\n2 3 1e3\n3 2 7\n"),
            path_of_three);
  EXPECT_EQ(graph_of("%%MATRIXMARKET MATRIX COORDINATE COMPLEX HERMITIAN\n3 3 2\n2 1 0 1\n3 2 0 1\n"), path_of_three);
  expect_refused(market + "array real general\n2 2\n", ":1: expected pattern");
  expect_refused("%%MatrixMarket matrix array real general\n2 2\n", ":1: expected coordinate");
  expect_refused("%%MatrixMarket vector coordinate real general\n2 2\n", ":1: expected matrix");
  expect_refused(market + "pattern triangular\n2 2 0\n", ":1: expected general, symmetric");
  expect_refused(market + "pattern general\n3 2 1\n1 2\n", ":2: expected a square matrix, found 3 rows and 2 columns");
  expect_refused(market + "pattern general\n3 3 2\n1 2\n", ":4: expected 2 entries, found 1");
  expect_refused(market + "pattern general\n3 3 1\n1 2\n2 3\n", ":4: expected nothing after 1 entries");
  expect_refused(market + "pattern general\n3 3 1\n1 4\n", ":3: expected a column from 1 to 3, found '4'");
  expect_refused(market + "pattern general\n", "expected the numbers of rows");
}

TEST(GraphReading, LeavesOutLoopsAndRepeatedEdgesWhenAsked) {
  const GraphReading tolerant{.tolerant = true};
  for (const std::string header : {"3 2", "3 3", "3 4"}) {
    LeftOut left_out;
    EXPECT_EQ(graph_of(header + "\n1 2 2\n1 1 3\n2\n", tolerant, &left_out), path_of_three) << header;
    EXPECT_EQ(left_out.loops, 1);
    EXPECT_EQ(left_out.repeated, 1);
  }
  expect_refused("3 1\n1 2 2\n1 1 3\n2\n", "expected 1 edges", tolerant);
  expect_refused("3 2\n2 2\n1 3\n2\n", "found 2 repeated (--tolerant takes it once)");
  expect_refused("3 2\n1 2\n1 3\n2\n", "--tolerant leaves them out");
  LeftOut left_out;
  EXPECT_EQ(graph_of("p edge 3 3\ne 1 2\ne 2 3\ne 3 3\n", tolerant, &left_out), path_of_three);
  EXPECT_EQ(left_out.loops, 1);
  expect_refused("p edge 3 3\ne 1 2\ne 2 3\ne 3 3\n",
                 ":4: expected no loops, found vertex 3 beside itself (--tolerant leaves them out)");
}

TEST(GraphReading, ScalesWeights) {
  const GraphReading scaled{.weight_scale = 1000};
  const ConflictGraph expected = make_graph({500, 1250, 3000}, {{0, 1}, {1, 2}});
  EXPECT_EQ(graph_of("3 2 10\n0.5 2\n1.25 1 3\n3 2\n", scaled), expected);
  EXPECT_EQ(graph_of("3 2 11\n5e-1 2 0.1\n1.25 1 0.1 3 2.5\n3 2 2.5\n", scaled), expected);
  EXPECT_EQ(graph_of("p edge 3 2\nn 1 0.5\nn 2 1.25\nn 3 3.0004\ne 1 2\ne 2 3\n", scaled), expected);
  expect_refused("3 2 10\n0.5 2\n1.25 1 3\n3 2\n",
                 ":2: expected the vertex weight, a whole number (--weight-scale takes others), found '0.5'");
  for (const std::string bad : {"-1", "1e300", "inf", "nan", "1x"})
    expect_refused("1 0 10\n" + bad + "\n", ":2: expected the vertex weight, a number that is not negative", scaled);
}

TEST(GraphReading, TakesTheComplement) {
  const GraphReading complement{.complement = true};
  EXPECT_EQ(graph_of("p edge 4 2\nn 1 7\ne 1 2\ne 2 3\n", complement),
            make_graph({7, 1, 1, 1}, {{0, 2}, {0, 3}, {1, 3}, {2, 3}}));
  EXPECT_EQ(graph_of("0 0\n", complement), ConflictGraph{});
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(20, random.uniform(), 100, random);
    std::string text = fmt::format("20 {} 10\n", graph.edge_count());
    for (std::int32_t v = 0; v < 20; ++v) {
      text += fmt::format("{}", graph.weights[v]);
      for (const std::int32_t u : graph.neighbours_of(v)) text += fmt::format(" {}", u + 1);
      text += '\n';
    }
    const ConflictGraph other = graph_of(text, complement);
    EXPECT_NO_THROW(validate(other, "complement"));
    EXPECT_EQ(other.edge_count(), 190 - graph.edge_count());
    for (std::int32_t v = 0; v < 20; ++v)
      for (std::int32_t u = 0; u < v; ++u) EXPECT_NE(other.has_edge(u, v), graph.has_edge(u, v));
  }
}

TEST(GraphReading, TakesALastLineWithoutEndWhereItsNumbersAreKnownToBeWhole) {
  EXPECT_EQ(graph_of("3 2\n2\n1 3\n2"), path_of_three);
  EXPECT_EQ(graph_of("3 2 10\n1 2\n1 1 3\n1 2"), path_of_three);
  EXPECT_EQ(graph_of("3 1\n2\n1\n\n"), make_graph({1, 1, 1}, {{0, 1}}));
  expect_refused("3 1 10\n1 2\n1 1\n1",
                 "expected the last line to have an end, found none; is the file cut off in its last weight?");
  std::string text = "12 1 10\n";
  for (int v = 1; v < 12; ++v) text += v == 1 ? "1 12\n" : "1\n";
  EXPECT_EQ(graph_of(text + "1 1").edge_count(), 1);
  expect_refused(text + "1 ", "neighbours");
}

}  // namespace
}  // namespace hexpipe
