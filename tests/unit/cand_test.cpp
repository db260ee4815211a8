#include "formats/choice/cand.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "tests/unit/written_bytes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

const char* const example =
    "hexpipe-candidates 1 3 9 1\n"
    "hex 0.8164965809277261 1 4 0 1 2 3 4 5 6 7 8 11 12 13 14\n"
    "prism 0.7071067811865475 0.5 3 1 9 10 11 12 13 14 20 21 22 30\n"
    "pyramid 0.25 1e-300 2 0 1 2 3 4 5 1 2147483647\n";

Candidates read_cand(const std::string& text) {
  Input input = Input::from_memory(text, "test.cand");
  return read_cand(input);
}

std::string written(const Candidates& candidates) {
  return hexpipe::testing::written_bytes([&](Output& output) { write_cand(candidates, output); });
}

void expect_cand_rejected(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { read_cand(text); }, ThrowsMessage<FormatError>(AllOf(StartsWith("test.cand:"), HasSubstr(message))))
      << text;
}

TEST(Cand, ReadsTheExample) {
  const Candidates c = read_cand(example);
  validate(c, "test");
  EXPECT_THAT(c.kind, ::testing::ElementsAre(CellKind::hex, CellKind::prism, CellKind::pyramid));
  EXPECT_EQ(c.vertices[1], (std::array<Vertex, 8>{8, 9, 10, 11, 12, 13, -1, -1}));
  EXPECT_EQ(c.quality[0], 0.8164965809277261);
  EXPECT_EQ(c.volume[2], 1e-300);
  EXPECT_THAT(c.interior_tets_of(1), ::testing::ElementsAre(19, 20, 21));
  EXPECT_THAT(c.boundary_tets_of(1), ::testing::ElementsAre(29));
  EXPECT_EQ(c.boundary_tets_of(2).size(), 0u);
}

TEST(Cand, WhatIsWrittenIsReadBack) {
  EXPECT_EQ(written(read_cand(example)), example);
  EXPECT_EQ(written(Candidates{}), "hexpipe-candidates 1 0 0 0\n");
  EXPECT_EQ(read_cand("hexpipe-candidates 1 0 0 0\n"), Candidates{});
}

TEST(Cand, TakesBlanksAndLineEndsAsTheyCome) {
  EXPECT_EQ(read_cand("hexpipe-candidates\t1  1 2 0\r\n pyramid .25 1 2 0  1 2 3 4 5 1 2 \r\n\n"),
            read_cand("hexpipe-candidates 1 1 2 0\npyramid 0.25 1 2 0 1 2 3 4 5 1 2\n"));
}

TEST(Cand, MessagesNameLineAndExpectation) {
  expect_cand_rejected("", ":1: expected hexpipe-candidates, found end of file");
  expect_cand_rejected("MeshVersionFormatted 2", ":1: expected hexpipe-candidates, found 'MeshVersionFormatted'");
  expect_cand_rejected("hexpipe-candidates 2 0 0 0\n", ":1: expected version 1, found 2");
  expect_cand_rejected("hexpipe-candidates 1 0 0\n", ":2: expected a number of boundary tets, found end of file");
  expect_cand_rejected("hexpipe-candidates 1 0 0 0 0\n", ":1: expected the end of the line, found '0'");
  expect_cand_rejected("hexpipe-candidates 1 -1 0 0\n", ":1: expected a number of candidates, found '-1'");
  const std::string header = "hexpipe-candidates 1 1 2 0\n";
  expect_cand_rejected(header + "cube 1 1 2 0 1 2 3 4 5 1 2\n", ":2: expected hex, prism or pyramid, found 'cube'");
  expect_cand_rejected(header + "tet 1 1 2 0 1 2 3 4 1 2\n     ", ":2: expected hex, prism or pyramid, found 'tet'");
  expect_cand_rejected(header + "pyramid x 1 2 0 1 2 3 4 5 1 2\n", ":2: expected the quality, found 'x'");
  expect_cand_rejected(header + "pyramid nan 1 2 0 1 2 3 4 5 1 2\n", ":2: expected the quality, found 'nan'");
  expect_cand_rejected(header + "pyramid 1 inf 2 0 1 2 3 4 5 1 2\n", ":2: expected the volume, found 'inf'");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 0 1 2\n", ":2: expected a vertex from 1 on, found 0");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 4 1 2\n", ":2: expected different vertices, found 4 twice");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 5 2 1\n", ":2: expected ascending tets, found 1 after 2");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 5 1 1\n", ":2: expected ascending tets, found 1 after 1");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 5 1\n2\n", ":2: expected a tet, found the end of the line");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 5 1 2 3\n", ":2: expected the end of the line, found '3'");
  expect_cand_rejected(header + "pyramid 1 1 1 0 1 2 3 4 5 1\n", "expected 2 interior tets in all, found 1");
  expect_cand_rejected(header + "pyramid 1 1 2 1 1 2 3 4 5 1 2 3\n", "expected 0 boundary tets in all, found 1");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 5 1 2\npyramid 1 1 2 0 1 2 3 4 5 1 2\n",
                       ":3: expected nothing after the last candidate, found 'pyramid'");
  expect_cand_rejected(header + "pyramid 1 1 2 0 1 2 3 4 5 1 3000000000\n", ":2: expected a tet, found '3000000000'");
}

// Before anything is allocated.
TEST(Cand, CountsThatTheFileCannotHoldAreRejected) {
  for (const char* header : {"hexpipe-candidates 1 1000000000000 0 0\n", "hexpipe-candidates 1 0 1000000000000 0\n",
                             "hexpipe-candidates 1 0 0 1000000000000\n"})
    expect_cand_rejected(std::string(header) + "pyramid 1 1 2 0 1 2 3 4 5 1 2\n", "that the rest of the file can hold");
  expect_cand_rejected("hexpipe-candidates 1 1 4 0\npyramid 1 1 4000000000 0 1 2 3 4 5 1 2 3 4\n",
                       ":2: expected a tet");
}

TEST(Cand, EveryTruncatedPrefixIsRejected) {
  const std::string text = example;
  for (std::size_t length = 0; length < text.size(); ++length)
    EXPECT_THROW(read_cand(text.substr(0, length)), FormatError) << length;
  expect_cand_rejected(text.substr(0, text.size() - 1), ":4: expected the end of the line, found end of file");
}

}  // namespace
}  // namespace hexpipe
