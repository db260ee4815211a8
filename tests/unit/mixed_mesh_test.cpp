#include "common/mesh/mixed_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/run/error.hpp"
#include "sample_meshes.hpp"

namespace hexpipe {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TetMesh one_tet() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.tet_tags = {5};
  mesh.triangles = {{1, 2, 3}};
  mesh.triangle_tags = {7};
  return mesh;
}

template <class Mesh>
void expect_invalid(const Mesh& mesh, const std::string& message) {
  EXPECT_THAT([&] { validate(mesh, "mesh"); }, ThrowsMessage<DataError>(HasSubstr(message)));
}

TEST(TetMesh, ValidMeshesPass) {
  EXPECT_NO_THROW(validate(one_tet(), "mesh"));
  EXPECT_NO_THROW(validate(TetMesh{}, "mesh"));
}

TEST(TetMesh, EveryDefectIsNamed) {
  TetMesh mesh = one_tet();
  mesh.tets[0][2] = 4;
  expect_invalid(mesh, "mesh: tets[0]: expected vertices from 0 to below 4, found 4");
  mesh = one_tet();
  mesh.triangles[0][0] = -1;
  expect_invalid(mesh, "mesh: triangles[0]: expected vertices from 0 to below 4, found -1");
  mesh = one_tet();
  mesh.tets[0][3] = 0;
  expect_invalid(mesh, "mesh: tets[0]: expected 4 different vertices, found 0 twice");
  mesh = one_tet();
  mesh.tet_tags.clear();
  expect_invalid(mesh, "mesh: expected a tag for each of 1 tets, found 0");
  mesh = one_tet();
  mesh.triangle_tags.push_back(1);
  expect_invalid(mesh, "mesh: expected a tag for each of 1 triangles, found 2");
  mesh = one_tet();
  mesh.points[1].z = std::numeric_limits<double>::infinity();
  expect_invalid(mesh, "mesh: points[1]: expected coordinates up to 1e+50, found 1 0 inf");
}

TEST(MixedMesh, ValidMeshesPass) {
  EXPECT_NO_THROW(validate(one_cell_of_each_kind(), "mesh"));
  for (std::uint64_t seed = 0; seed < 20; ++seed) EXPECT_NO_THROW(validate(random_mesh(seed), "mesh"));
}

TEST(MixedMesh, EveryBlockIsChecked) {
  const auto check = [](auto member, const char* name) {
    MixedMesh mesh = one_cell_of_each_kind();
    (mesh.*member).cells[0][0] = 11;
    expect_invalid(mesh, std::string(name) + "[0]: expected vertices from 0 to below 11, found 11");
    mesh = one_cell_of_each_kind();
    (mesh.*member).cells[0][0] = (mesh.*member).cells[0][1];
    expect_invalid(mesh, std::string(name) + "[0]: expected");
    mesh = one_cell_of_each_kind();
    (mesh.*member).tags.pop_back();
    expect_invalid(mesh, name);
    mesh = one_cell_of_each_kind();
    (mesh.*member).quality.resize(9);
    expect_invalid(mesh, "expected a quality for each");
    for (const double quality : {std::nan(""), HUGE_VAL}) {
      mesh = one_cell_of_each_kind();
      (mesh.*member).quality = {quality};
      (mesh.*member).quality.resize((mesh.*member).size(), 0.5);
      expect_invalid(mesh, std::string(name) + "_quality[0]: expected a finite number, found ");
    }
  };
  check(&MixedMesh::hexes, "hexes");
  check(&MixedMesh::prisms, "prisms");
  check(&MixedMesh::pyramids, "pyramids");
  check(&MixedMesh::tets, "tets");
  check(&MixedMesh::triangles, "triangles");
  check(&MixedMesh::quads, "quads");
}

TEST(MixedMesh, TetMeshesConvertBothWays) {
  EXPECT_TRUE(to_tet_mesh(to_mixed_mesh(one_tet()), "mesh") == one_tet());
}

TEST(MixedMesh, OtherCellsMakeNoTetMesh) {
  EXPECT_THAT([] { to_tet_mesh(one_cell_of_each_kind(), "mesh"); },
              ThrowsMessage<DataError>(HasSubstr("mesh: expected tets and triangles only, found 1 hexes")));
  MixedMesh mesh = to_mixed_mesh(one_tet());
  mesh.quads = {{{0, 1, 2, 3}}, {0}, {}};
  EXPECT_THAT([&] { to_tet_mesh(mesh, "mesh"); }, ThrowsMessage<DataError>(HasSubstr("found 1 quads")));
}

}  // namespace
}  // namespace hexpipe
