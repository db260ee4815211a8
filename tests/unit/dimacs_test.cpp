#include "formats/choice/dimacs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "formats/choice/graph_reading.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace formats;
using namespace graph;
namespace {

using hexpipe::testing::make_graph;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ConflictGraph read_dimacs(const std::string& text) {
  Input input = Input::from_memory(text, "test.col");
  return read_graph(input, {.format = GraphFormat::dimacs});
}

void expect_dimacs_rejected(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { read_dimacs(text); }, ThrowsMessage<DataError>(AllOf(HasSubstr("test.col"), HasSubstr(message))))
      << text;
}

const ConflictGraph path = make_graph({5, 7, 5}, {{0, 1}, {1, 2}});

TEST(Dimacs, ReadsItsVariants) {
  EXPECT_EQ(read_dimacs("c a path\np edge 3 2\nn 1 5\nn 2 7\nn 3 5\ne 1 2\ne 2 3\n"), path);
  EXPECT_EQ(read_dimacs("p edge 3 2\r\nv 1 5\r\nv 2 7\r\nv 3 5\r\ne 1 2\r\ne 2 3\r\n"), path)
      << "weights of vertex covers";
  EXPECT_EQ(read_dimacs("\nc\n\np col 3 2\ne 3 2\nn 3 5\n\nn 1 5\nc more\ne 2 1\nn 2 7\n"), path) << "any order";
  const ConflictGraph unweighted = make_graph({1, 1, 1}, {{0, 1}, {1, 2}});
  EXPECT_EQ(read_dimacs("p td 3 2\n1 2\n2 3\n"), unweighted) << "PACE";
  EXPECT_EQ(read_dimacs("p edge 3 4\ne 1 2\ne 2 1\ne 2 3\ne 3 2\n"), unweighted) << "both directions, counted twice";
  EXPECT_EQ(read_dimacs("p edge 3 2\ne 1 2\ne 2 1\ne 2 3\ne 3 2\n"), unweighted) << "both directions, counted once";
  EXPECT_EQ(read_dimacs("p edge 2 0\n"), make_graph({1, 1}, {}));
  EXPECT_EQ(read_dimacs("p edge 0 0\n"), ConflictGraph{});
}

TEST(Dimacs, AgreesWithRandomGraphs) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(30, 0.2, 100, random);
    std::string text = fmt::format("p edge 30 {}\n", graph.edge_count());
    for (std::int32_t v = 0; v < 30; ++v) {
      text += fmt::format("n {} {}\n", v + 1, graph.weights[v]);
      for (const std::int32_t u : graph.neighbours_of(v))
        if (u < v) text += fmt::format("e {} {}\n", v + 1, u + 1);
    }
    EXPECT_EQ(read_dimacs(text), graph);
  }
}

TEST(Dimacs, NamesTheLine) {
  const std::string begin = "c\np edge 3 2\n";
  expect_dimacs_rejected("", "expected a problem line");
  expect_dimacs_rejected("c only\n", "expected a problem line");
  expect_dimacs_rejected("e 1 2\n", "test.col:1: expected a problem line");
  expect_dimacs_rejected("p edge x 2\n", "test.col:1: expected the number of vertices, found 'x'");
  expect_dimacs_rejected("p edge 3\n", "test.col:1: expected the number of edges, found the end of the line");
  expect_dimacs_rejected("p edge 3 2 1\n", "test.col:1: expected the end of the problem line, found '1'");
  expect_dimacs_rejected("p edge 3000000000 0\n", "test.col:1: expected fewer than 2^31 vertices");
  expect_dimacs_rejected("p edge 2000000000 0\n",
                         "test.col:1: expected at most 1000000 vertices in a file of this size");
  expect_dimacs_rejected("p edge 3 1000000000000\n", "test.col:1: expected 1000000000000 edges, found less");
  expect_dimacs_rejected(begin + "e 1 4\ne 1 2\n", "test.col:3: expected a vertex from 1 to 3, found '4'");
  expect_dimacs_rejected(begin + "e 0 1\ne 1 2\n", "test.col:3: expected a vertex from 1 to 3, found '0'");
  expect_dimacs_rejected(begin + "e 1 2\ne 3 3\n", "test.col:4: expected no loops, found vertex 3 beside itself");
  expect_dimacs_rejected(begin + "e 1 2 3\n", "test.col:3: expected the end of the line, found '3'");
  expect_dimacs_rejected(begin + "e 1\n", "test.col:3: expected a vertex, found the end of the line");
  expect_dimacs_rejected(begin + "x 1 2\n", "test.col:3: expected a line of c, n, v or e, or an edge, found 'x'");
  expect_dimacs_rejected(begin + "n 1 5\nn 1 5\n", "test.col:4: expected one weight a vertex");
  expect_dimacs_rejected(begin + "n 1 -5\n", "test.col:3: expected the weight, found '-5'");
  expect_dimacs_rejected(begin + "n 1 9223372036854775807\n", "test.col:3: expected weights whose sum fits 64 bits");
  expect_dimacs_rejected(begin + "n 1 9223372036854775808\n", "test.col:3: expected the weight that fits 64 bits");
  expect_dimacs_rejected(begin + "e 1 2\n", "test.col:3: expected 2 edges as the problem line says, found 1");
  expect_dimacs_rejected("p edge 3 1\ne 1 2\ne 2 1\ne 2 3\n", "test.col:4: expected 1 edges as the problem line says");
  expect_dimacs_rejected(begin + "e 1 2\n" + std::string(1, '\0') + "\n",
                         "test.col:4: expected a line of c, n, v or e");
}

TEST(Dimacs, RefusesAFileThatIsCutOffInItsLastNumber) {
  const std::string text = "p edge 3 2\ne 1 2\ne 2 3\nn 1 55";
  EXPECT_NO_THROW(read_dimacs(text + "\n"));
  expect_dimacs_rejected(text, "test.col: expected the last line to have an end, found none; is the file cut off?");
}

TEST(Dimacs, KeepsControlCharactersOutOfMessages) {
  expect_dimacs_rejected("p edge \x1b[31m 2\n", "test.col:1: expected the number of vertices, found '?[31m'");
}

TEST(Dimacs, IsToldByItsFirstLetter) {
  const auto told = [](const std::string& text) {
    Input input = Input::from_memory(text, "test");
    return looks_like_dimacs(input);
  };
  EXPECT_TRUE(told("c comment\n"));
  EXPECT_TRUE(told("\n p edge 1 0\n"));
  EXPECT_FALSE(told("3 2 10\n"));
  EXPECT_FALSE(told("% comment\n3 2 10\n"));
  EXPECT_FALSE(told(""));
}

}  // namespace
}  // namespace hexpipe
