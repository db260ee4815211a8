#include "common/mesh/candidates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/run/error.hpp"
#include "tests/unit/list_of.hpp"

namespace hexpipe {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

Candidates a_hex_and_a_pyramid() {
  Candidates c;
  c.vertices = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 8, -1, -1, -1}};
  c.kind = {CellKind::hex, CellKind::pyramid};
  c.quality = {1, 0.5};
  c.volume = {1, 0.25};
  c.tets = testing::list_of<TetIndex>({0, 1, 2, 3, 4, 5, 6});
  c.tet_offsets = {0, 5, 7};
  c.boundary_tets = {TetIndex(9)};
  c.boundary_tet_offsets = {0, 1, 1};
  return c;
}

void expect_rejected(void (*spoil)(Candidates&), const char* message) {
  Candidates c = a_hex_and_a_pyramid();
  spoil(c);
  EXPECT_THAT([&] { validate(c, "file"); }, ThrowsMessage<DataError>(AllOf(StartsWith("file: "), HasSubstr(message))));
}

TEST(Candidates, ValidOnesPass) {
  EXPECT_NO_THROW(validate(a_hex_and_a_pyramid(), "file"));
  EXPECT_NO_THROW(validate(Candidates{}, "file"));
}

TEST(Candidates, SpoiltOnesAreRejected) {
  expect_rejected([](Candidates& c) { c.vertices.pop_back(); }, "2 rows of vertices, found 1");
  expect_rejected([](Candidates& c) { c.quality.push_back(1); }, "2 qualities, found 3");
  expect_rejected([](Candidates& c) { c.volume.clear(); }, "2 volumes, found 0");
  expect_rejected([](Candidates& c) { c.kind[0] = CellKind::tet; }, "kind 12, 13 or 14 of candidate 1, found 10");
  expect_rejected([](Candidates& c) { c.kind[0] = static_cast<CellKind>(99); }, "found 99");
  expect_rejected([](Candidates& c) { c.kind[0] = CellKind::prism; }, "-1 after the 6 vertices");
  expect_rejected([](Candidates& c) { c.kind[1] = CellKind::hex; }, "8 vertices of candidate 2, found -1");
  expect_rejected([](Candidates& c) { c.vertices[0][3] = 1; }, "found 1 twice");
  expect_rejected([](Candidates& c) { c.quality[1] = std::numeric_limits<double>::quiet_NaN(); }, "finite quality");
  expect_rejected([](Candidates& c) { c.volume[1] = std::numeric_limits<double>::infinity(); }, "finite volume");
  expect_rejected([](Candidates& c) { c.tet_offsets = {0, 5}; }, "3 offsets of tets, found 2");
  expect_rejected([](Candidates& c) { c.tet_offsets = {1, 5, 7}; }, "from 0");
  expect_rejected([](Candidates& c) { c.tet_offsets = {0, 8, 7}; }, "ascending offsets");
  expect_rejected([](Candidates& c) { c.tet_offsets = {0, 5, 1'000'000'000'000}; }, "up to 7");
  expect_rejected([](Candidates& c) { c.boundary_tet_offsets.clear(); }, "3 offsets of boundary tets, found 0");
  expect_rejected([](Candidates& c) { std::swap(c.tets[1], c.tets[2]); }, "ascending tets of candidate 1");
  expect_rejected([](Candidates& c) { c.tets[6] = TetIndex(5); }, "ascending tets of candidate 2");
  expect_rejected([](Candidates& c) { c.boundary_tets[0] = no_index; }, "boundary tets of candidate 1, found -1");
}

TEST(Candidates, AreCheckedAgainstTheirMesh) {
  const Candidates c = a_hex_and_a_pyramid();
  TetMesh mesh;
  mesh.points.resize(9);
  mesh.tets.resize(10);
  EXPECT_NO_THROW(validate_against(c, mesh, "file"));
  mesh.points.resize(8);
  EXPECT_THAT([&] { validate_against(c, mesh, "file"); },
              ThrowsMessage<DataError>("file: expected vertices below 8 in candidate 2, found 8"));
  mesh.points.resize(9);
  mesh.tets.resize(9);
  EXPECT_THAT([&] { validate_against(c, mesh, "file"); },
              ThrowsMessage<DataError>("file: expected tets below 9 in candidate 1, found 9"));
  mesh.tets.resize(6);
  EXPECT_THAT([&] { validate_against(c, mesh, "file"); }, ThrowsMessage<DataError>(HasSubstr("found 9")));
}

}  // namespace
}  // namespace hexpipe
