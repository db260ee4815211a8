#include "formats/meshes/group_naming.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_meshes.hpp"

namespace hexpipe {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

constexpr NameRules strict{
    .format = "Test", .longest = 8, .others = "", .folds_case = true, .begins_with_letter = true, .ascii_only = true};

// Surfaces 7, 10, 20, 30 and regions 1 to 4, of these names.
struct Named {
  MixedMesh mesh = one_cell_of_each_kind();
  MeshWriting writing;
  std::vector<std::string> told;

  explicit Named(GroupNames names) {
    writing.names = std::move(names);
    writing.tell = [this](const std::string& line) { told.push_back(line); };
  }
  std::map<std::int32_t, std::string> surfaces(const NameRules& rules) {
    return GroupNaming(mesh, GroupKind::surface, writing, rules).all();
  }
};

TEST(GroupNaming, NamesGroupsWithoutNamesByKindAndTag) {
  EXPECT_EQ(group_name({}, GroupKind::surface, 3), "surface_3");
  EXPECT_EQ(group_name({}, GroupKind::region, -1), "region_-1");
  EXPECT_EQ(group_name({{{3, "inlet"}}, {}, {}}, GroupKind::surface, 3), "inlet");
  EXPECT_EQ(told_tag("surface_3", GroupKind::surface), 3);
  EXPECT_EQ(told_tag("region_m1", GroupKind::region), -1);
  EXPECT_EQ(told_tag("region_-2147483648", GroupKind::region), -2147483648);
  for (const char* name : {"surface_", "surface_3a", "surface_2147483648", "region_3", "inlet"})
    EXPECT_EQ(told_tag(name, GroupKind::surface), std::nullopt) << name;
}

TEST(GroupNaming, ChangesNamesAsLittleAsTheFormatNeeds) {
  Named named({{{7, "2 holes"}, {10, "a name too long"}, {20, "outlet"}}, {}, {}});
  EXPECT_THAT(named.surfaces(strict),
              ElementsAre(Pair(7, "g_2_hole"), Pair(10, "a_name_t"), Pair(20, "outlet"), Pair(30, "surface_")));
  EXPECT_THAT(named.told, ElementsAre("surface '2 holes' is written as g_2_hole: Test allows no such name, or another "
                                      "has it",
                                      "surface 'a name too long' is written as a_name_t: Test allows no such name, or "
                                      "another has it"));
}

TEST(GroupNaming, KeepsNamesApartThatReadersTakeForOne) {
  Named named({{{7, "wall"}, {10, "WALL"}, {20, "wall?"}, {30, "wall"}}, {}, {}});
  // Tags of one name are one group.
  EXPECT_THAT(named.surfaces(strict),
              ElementsAre(Pair(7, "wall"), Pair(10, "WALL_2"), Pair(20, "wall_"), Pair(30, "wall")));
  EXPECT_EQ(named.told.size(), 2u);
}

TEST(GroupNaming, CutsNoCharacterInTwo) {
  NameRules rules = strict;
  rules.ascii_only = false;
  Named named({{{7, "Gehäuse"}, {10, "Abflüsse"}, {20, "abcdefgü"}}, {}, {}});
  EXPECT_THAT(named.surfaces(rules),
              ElementsAre(Pair(7, "Gehäuse"), Pair(10, "Abflüss"), Pair(20, "abcdefg"), Pair(30, "surface_")));
  EXPECT_EQ(named.surfaces(strict).at(7), "Geh__use");
}

TEST(GroupNaming, GivesRegionsOtherNamesThanSurfaces) {
  Named named({{{7, "steel"}}, {{1, "steel"}, {2, "ALL"}}, {}});
  const GroupNamings names(named.mesh, named.writing, strict, {"all"});
  EXPECT_EQ(names.surfaces.of(7), "steel");
  EXPECT_THAT(names.regions.list(), ElementsAre("steel_2", "ALL_2", "region_3", "region_4"));
}

TEST(GroupNaming, NumbersSurfacesAndRegionsApartWhereAskedFor) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.quads.tags = {1, 2, 0};
  mesh.hexes.tags = {-5};
  EXPECT_THAT(group_numbers(mesh, false).surfaces,
              ElementsAre(Pair(0, 3), Pair(1, 1), Pair(2, 2), Pair(10, 10), Pair(20, 20), Pair(30, 30)));
  EXPECT_THAT(group_numbers(mesh, false).regions, ElementsAre(Pair(-5, 1), Pair(2, 2), Pair(3, 3), Pair(4, 4)));
  EXPECT_THAT(group_numbers(mesh, true).regions, ElementsAre(Pair(-5, 5), Pair(2, 6), Pair(3, 7), Pair(4, 4)));
  EXPECT_THAT(group_numbers(mesh, false, 9).surfaces,
              ElementsAre(Pair(0, 3), Pair(1, 1), Pair(2, 2), Pair(10, 4), Pair(20, 5), Pair(30, 6)));
}

}  // namespace
}  // namespace hexpipe
