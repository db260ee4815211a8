#include "formats/meshes/facet_owners.hpp"

#include <gtest/gtest.h>

#include "formats/meshes/cell_data.hpp"
#include "sample_meshes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

void expect_owner(const FacetOwner& owner, CellKind kind, std::int64_t cell, int facet) {
  EXPECT_EQ(owner.kind, kind);
  EXPECT_EQ(owner.cell, cell);
  EXPECT_EQ(owner.facet, facet);
}

TEST(FacetOwners, EachFacetFindsItsCell) {
  const FacetOwners owners = find_facet_owners(one_cell_of_each_kind());
  expect_owner(owners.triangles.at(0), CellKind::prism, 0, 0);
  expect_owner(owners.triangles.at(1), CellKind::tet, 0, 0);
  expect_owner(owners.triangles.at(2), CellKind::pyramid, 0, 0);
  expect_owner(owners.quads.at(0), CellKind::hex, 0, 0);
  expect_owner(owners.quads.at(1), CellKind::hex, 0, 2);
  expect_owner(owners.quads.at(2), CellKind::hex, 0, 3);
}

TEST(FacetOwners, TheCellThatAFacetPointsOutOfComesFirst) {
  MixedMesh mesh = one_cell_of_each_kind();
  // The quad between hex and pyramid, turned round.
  mesh.quads.cells[2] = {5, 6, 2, 1};
  expect_owner(find_facet_owners(mesh).quads.at(2), CellKind::pyramid, 0, 0);
  // On the boundary the only cell is taken either way.
  mesh.quads.cells[0] = {0, 1, 2, 3};
  expect_owner(find_facet_owners(mesh).quads.at(0), CellKind::hex, 0, 0);
}

TEST(FacetOwners, AFacetOfNoCellHasNone) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.triangles.cells[0] = {0, 1, 2};
  mesh.quads.cells[0] = {0, 1, 2, 8};
  const FacetOwners owners = find_facet_owners(mesh);
  EXPECT_EQ(owners.triangles.at(0).cell, -1);
  EXPECT_EQ(owners.quads.at(0).cell, -1);
}

TEST(FacetOwners, RepeatedFacetsAllFindTheirCell) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.triangles.cells.push_back(mesh.triangles.cells[0]);
  const FacetOwners owners = find_facet_owners(mesh);
  expect_owner(owners.triangles.at(0), CellKind::prism, 0, 0);
  expect_owner(owners.triangles.at(3), CellKind::prism, 0, 0);
}

TEST(CellData, FacetsShowWhatTheirCellsHave) {
  const CellData data = cell_data(one_cell_of_each_kind());
  const std::vector<std::int32_t> region{1, 2, 3, 4, 2, 4, 3, 1, 1, 1};
  const std::vector<std::int32_t> surface{0, 0, 0, 0, 30, 10, 20, 10, 20, 7};
  const std::vector<std::uint8_t> kind{12, 13, 14, 10, 13, 10, 14, 12, 12, 12};
  const std::vector<double> quality{1, 0.75, 0.1, 1.0 / 3, 0.75, 1.0 / 3, 0.1, 1, 1, 1};
  EXPECT_EQ(data.region, region);
  EXPECT_EQ(data.surface, surface);
  EXPECT_EQ(data.kind, kind);
  EXPECT_EQ(data.quality, quality);
}

TEST(CellData, AFacetOfNoCellShowsItself) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.triangles.cells[0] = {0, 1, 2};
  const CellData data = cell_data(mesh);
  EXPECT_EQ(data.region[4], 0);
  EXPECT_EQ(data.surface[4], 30);
  EXPECT_EQ(data.kind[4], 5);
  EXPECT_EQ(data.quality[4], 1);
}

TEST(CellData, QualityNeedsThatOfEveryCell) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.prisms.quality.clear();
  EXPECT_TRUE(cell_data(mesh).quality.empty());
}

}  // namespace
}  // namespace hexpipe
