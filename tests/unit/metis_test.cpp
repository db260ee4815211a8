#include "formats/choice/metis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "formats/choice/graph_reading.hpp"
#include "random_graphs.hpp"
#include "tests/unit/written_bytes.hpp"

namespace hexpipe {
using namespace formats;
using namespace graph;
namespace {

using hexpipe::testing::make_graph;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ConflictGraph read(const std::string& text) {
  Input input = Input::from_memory(text, "test.graph");
  return read_graph(input, {.format = GraphFormat::metis});
}

void expect_rejected(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { read(text); }, ThrowsMessage<DataError>(AllOf(HasSubstr("test.graph"), HasSubstr(message))))
      << text;
}

std::string written(const ConflictGraph& graph) {
  return hexpipe::testing::written_bytes([&](Output& output) { write_metis(graph, output); });
}

TEST(Metis, ReadsEveryKindOfWeights) {
  EXPECT_EQ(read("3 2 10\n5 2\n7 1 3\n5 2\n"), make_graph({5, 7, 5}, {{0, 1}, {1, 2}}));
  EXPECT_EQ(read("3 2\n2\n1 3\n2\n"), make_graph({1, 1, 1}, {{0, 1}, {1, 2}}));
  EXPECT_EQ(read("3 2 0\n2\n1 3\n2\n"), make_graph({1, 1, 1}, {{0, 1}, {1, 2}}));
  EXPECT_EQ(read("3 2 1\n2 9\n1 9 3 8\n2 8\n"), make_graph({1, 1, 1}, {{0, 1}, {1, 2}}));
  EXPECT_EQ(read("3 2 011 1\n5 2 9\n7 1 9 3 8\n5 2 8\n"), make_graph({5, 7, 5}, {{0, 1}, {1, 2}}));
  EXPECT_EQ(read("3 2 010\n0 2\n7 1 3\n5 2\n"), make_graph({0, 7, 5}, {{0, 1}, {1, 2}}));
}

TEST(Metis, ReadsWhatPeopleWrite) {
  const ConflictGraph expected = make_graph({1, 1, 1}, {{0, 1}, {1, 2}});
  EXPECT_EQ(read("% a comment\n3 2\n2\n% another\n1 3\n2\n% the last\n"), expected);
  EXPECT_EQ(read("3 2\r\n2\r\n1 3\r\n2\r\n"), expected);
  EXPECT_EQ(read(" 3  2 \n 2\t\n3 1\n2\n"), expected) << "blanks, any order";
  EXPECT_EQ(read("3 2\n2\n1 3\n2\n\n\n"), expected);
  EXPECT_EQ(read("3 1\n3\n\n1\n"), make_graph({1, 1, 1}, {{0, 2}})) << "an empty line is an isolated vertex";
  EXPECT_EQ(read("0 0\n"), ConflictGraph{});
  EXPECT_EQ(read("0 0 10\n"), ConflictGraph{});
  EXPECT_EQ(read("1 0 10\n9223372036854775807\n"), make_graph({9223372036854775807}, {}));
}

TEST(Metis, NamesTheLineOfWhatIsWrong) {
  expect_rejected("", "empty");
  expect_rejected("\n", ":1: expected the number of vertices, found the end of the line");
  expect_rejected("x 2\n", ":1: expected the number of vertices, found 'x'");
  expect_rejected("3\n", ":1: expected the number of edges");
  expect_rejected("-3 2\n", ":1: expected the number of vertices, found '-3'");
  expect_rejected("3 2 20\n", ":1: expected a format");
  expect_rejected("3 2 100\n", "vertex sizes");
  expect_rejected("3 2 10 2\n", "one weight a vertex");
  expect_rejected("3 2 10 1 5\n", ":1: expected the end of the header, found '5'");
  expect_rejected("3 2\n2\n1 4\n2\n", ":3: expected a neighbour from 1 to 3, found '4'");
  expect_rejected("3 2\n2\n1 0\n2\n", ":3: expected a neighbour from 1 to 3, found '0'");
  expect_rejected("3 2\n2\n1 3x\n2\n", ":3: expected a neighbour, found '3x'");
  expect_rejected("3 2\n% c\n2\n1 3.5\n2\n", ":4: expected a neighbour, found '3.5'");
  expect_rejected("3 2\n1\n1 3\n2\n", ":2: expected no loops, found vertex 1");
  expect_rejected("3 2\n2\n3 3\n2\n", ":3: expected each neighbour once, found 3 repeated");
  expect_rejected("3 2\n2\n% c\n1 3\n1\n", ":5: expected every edge at both ends, found 1 beside 3");
  expect_rejected("3 2\n2\n1 3\n", ":4: expected the lines of 3 vertices, found 2");
  expect_rejected("3 2\n2\n1 3\n2\n1\n", ":5: expected nothing after");
  expect_rejected("3 1\n2\n1 3\n2\n", "expected 1 edges as the header says, found more");
  expect_rejected("4 3\n2\n1 3\n2\n\n", "expected 3 edges (6 neighbours)");
  expect_rejected("2 0 10\n5\n\n", ":3: expected the vertex weight, found the end of the line");
  expect_rejected("2 0 10\n5\n-1\n", ":3: expected the vertex weight, found '-1'");
  expect_rejected("1 0 10\n9223372036854775808\n", ":2: expected the vertex weight that fits 64 bits");
  expect_rejected("1 0 10\n99999999999999999999999\n", ":2: expected the vertex weight that fits 64 bits");
  expect_rejected("2 0 10\n9223372036854775807\n1\n", ":3: expected weights whose sum fits 64 bits");
}

// A header must not make the reader allocate what the file cannot fill.
TEST(Metis, DistrustsCounts) {
  expect_rejected("2000000000 0\n", ":1: expected a line for each of 2000000000 vertices");
  expect_rejected("3000000000 0\n", ":1: expected fewer than 2^31 vertices");
  expect_rejected("3 1000000000000000\n1\n2\n3\n", ":1: expected both ends of 1000000000000000 edges");
  expect_rejected("3 18446744073709551615\n1\n2\n3\n", ":1: expected both ends");
  expect_rejected("3 184467440737095516150\n1\n2\n3\n", "fits 64 bits");
}

TEST(Metis, RejectsEveryTruncatedPrefix) {
  const std::string text = "4 4 10\n11 2 3\n12 1 3\n13 1 2 4\n14 3\n";
  EXPECT_NO_THROW(read(text));
  for (std::size_t length = 0; length + 1 < text.size(); ++length) {
    const std::string prefix = text.substr(0, length);
    EXPECT_THROW(read(prefix), DataError) << prefix;
  }
  // A weight is no shorter for it.
  expect_rejected("2 0 10\n11\n12", "test.graph: expected the last line to have an end, found none");
}

TEST(Metis, WritesWhatItReads) {
  EXPECT_EQ(written(make_graph({5, 7, 5, 1}, {{0, 1}, {1, 2}})), "4 2 10\n5 2\n7 1 3\n5 2\n1\n");
  EXPECT_EQ(written(ConflictGraph{}), "0 0 10\n");
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(40, 0.2, std::int64_t{1} << 50, random);
    EXPECT_EQ(read(written(graph)), graph);
  }
}

TEST(Metis, WarnsOfOtherProgramsLimits) {
  const auto warning = [](std::int64_t total) { return metis_weight_warning(make_graph({total - 1, 1}, {})); };
  EXPECT_FALSE(warning((std::int64_t{1} << 31) - 1));
  EXPECT_THAT(warning(std::int64_t{1} << 31).value(), AllOf(HasSubstr("2^31"), HasSubstr("10 times smaller")));
  EXPECT_THAT(warning(std::int64_t{1} << 32).value(), AllOf(HasSubstr("2^32"), HasSubstr("10 times smaller")));
  EXPECT_THAT(warning(1000000000000).value(), AllOf(HasSubstr("KaMIS"), HasSubstr(" 1000 times smaller")));
}

}  // namespace
}  // namespace hexpipe
