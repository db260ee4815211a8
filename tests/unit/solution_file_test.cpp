#include "formats/choice/solution_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "tests/unit/written_bytes.hpp"

namespace hexpipe {
using namespace formats;
using namespace graph;
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

IndependentSet read(const std::string& text, std::int64_t vertex_count) {
  Input input = Input::from_memory(text, "test.sol");
  return read_solution(input, vertex_count);
}

void expect_rejected(const std::string& text, const char* message) {
  EXPECT_THAT([&] { read(text, 5); }, ThrowsMessage<DataError>(HasSubstr(message))) << text;
}

TEST(SolutionFile, ReadsNumbersFromOne) {
  EXPECT_EQ(read("2\n5\n", 5), (IndependentSet{1, 4}));
  EXPECT_EQ(read("5\n2\n", 5), (IndependentSet{1, 4})) << "any order";
  EXPECT_EQ(read(" 5 \r\n2\r\n\n", 5), (IndependentSet{1, 4}));
  EXPECT_EQ(read("1\n", 5), (IndependentSet{0}));
}

TEST(SolutionFile, ReadsALineForEachVertex) {
  EXPECT_EQ(read("0\n1\n0\n0\n1\n", 5), (IndependentSet{1, 4}));
  EXPECT_EQ(read("0\n0\n0\n0\n0\n", 5), (IndependentSet{}));
}

TEST(SolutionFile, TellsTheFormsApartByTheGraph) {
  EXPECT_EQ(read("1\n", 1), (IndependentSet{0})) << "the one file that is both";
  EXPECT_EQ(read("0\n", 1), (IndependentSet{}));
  EXPECT_EQ(read("1\n2\n3\n", 3), (IndependentSet{0, 1, 2})) << "as many lines as vertices, but not 0 or 1";
  EXPECT_EQ(read("1\n0\n", 2), (IndependentSet{0}));
  EXPECT_THROW(read("1\n0\n", 3), FormatError) << "another graph's line for each vertex";
  EXPECT_EQ(read("", 0), (IndependentSet{}));
}

TEST(SolutionFile, NamesTheLineOfWhatIsWrong) {
  expect_rejected("", "test.sol: expected a solution, found no numbers");
  expect_rejected("1\n6\n", "test.sol:2: expected a vertex from 1 to 5");
  expect_rejected("1\n0\n", "test.sol:2: expected a vertex from 1 to 5");
  expect_rejected("-1\n", "test.sol:1: expected a vertex from 1 to 5");
  expect_rejected("2\n4\n2\n", "test.sol:3: expected each vertex once, found 2 again");
  expect_rejected("2\nx\n", "test.sol:2: expected one number, found 'x'");
  expect_rejected("2 3\n", "test.sol:1: expected one number, found '2 3'");
  expect_rejected("2\n\n3\n", "test.sol:2: expected a number, found an empty line");
  expect_rejected("99999999999999999999\n", "test.sol:1: expected one number");
}

// Every prefix is rejected, or is itself a whole file.
TEST(SolutionFile, RejectsTruncatedLinesForEachVertex) {
  const std::string text = "0\n1\n0\n0\n1\n";
  for (std::size_t length = 0; length + 1 < text.size(); ++length)
    EXPECT_THROW(read(text.substr(0, length), 5), DataError) << length;
}

TEST(SolutionFile, RefusesAFileThatIsCutOffInItsLastNumber) {
  expect_rejected("1\n2", "test.sol: expected the last line to have an end, found none; is the file cut off?");
}

TEST(SolutionFile, WritesNumbersFromOne) {
  EXPECT_EQ(hexpipe::testing::written_bytes([](Output& output) { write_solution({1, 4}, output); }), "2\n5\n");
}

}  // namespace
}  // namespace hexpipe
