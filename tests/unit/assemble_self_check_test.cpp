#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "assemble_lattice.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/run/error.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/self_check.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::hybrid;
using namespace assemble::shape;
namespace {

using ::testing::HasSubstr;

// A conforming result with all kinds of facets, to be damaged.
class SelfCheck : public ::testing::Test {
 protected:
  SelfCheck() : lattice_(testing::make_lattice(3)) {
    lattice_.mesh.tet_tags.back() = 2;  // one tet is a region of its own
    add_missing_boundary_triangles(lattice_.mesh, TetAdjacency(lattice_.mesh, "test"), 0);
    result_.mesh = assemble::assemble(lattice_.mesh, lattice_.cubes, {0, 13}, {.smooth = 0}).mesh;
    result_.origin.resize(result_.mesh.points.size());
    std::iota(result_.origin.begin(), result_.origin.end(), 0);  // no vertex of the lattice is dropped
  }
  std::string error(bool conforming = true) const {
    try {
      check_result(result_, lattice_.mesh, SurfaceTags(lattice_.mesh),
                   InputSurface(lattice_.mesh, TetAdjacency(lattice_.mesh, "mesh")), conforming);
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  }

  testing::Lattice lattice_;
  Extract result_;
};

TEST_F(SelfCheck, PassesWhatIsRight) {
  EXPECT_EQ(result_.mesh.pyramids.size(), 9u);
  EXPECT_EQ(error(), "");
}

TEST_F(SelfCheck, FindsAnInvertedCell) {
  std::swap(result_.mesh.tets.cells[0][0], result_.mesh.tets.cells[0][1]);
  EXPECT_THAT(error(), HasSubstr("invalid tet"));
}

TEST_F(SelfCheck, FindsAHexThatIsInvalidBetweenItsCorners) {
  auto& points = result_.mesh.points;
  const auto& hex = result_.mesh.hexes.cells[0];
  // Corners stay positive, the middle does not: the top is turned by nearly a right angle and pressed down.
  const Vec3 turned[4] = {{1, 0, 0.1}, {1, 1, 0.1}, {0, 1, 0.1}, {0, 0, 0.1}};
  for (int i = 0; i < 4; ++i) points[hex[i + 4]] = turned[i];
  EXPECT_THAT(error(), HasSubstr("invalid"));
}

TEST_F(SelfCheck, FindsAMissingCell) {
  result_.mesh.tets.cells.pop_back();
  result_.mesh.tets.tags.pop_back();
  EXPECT_THAT(error(), HasSubstr("self-check"));
}

TEST_F(SelfCheck, FindsADuplicateCell) {
  result_.mesh.tets.cells.push_back(result_.mesh.tets.cells.back());
  result_.mesh.tets.tags.push_back(result_.mesh.tets.tags.back());
  EXPECT_THAT(error(), HasSubstr("one cell on each side"));
}

TEST_F(SelfCheck, FindsAMissingTag) {
  result_.mesh.triangles.cells.pop_back();
  result_.mesh.triangles.tags.pop_back();
  EXPECT_THAT(error(), HasSubstr("tagged"));
  result_.mesh.quads.cells.pop_back();
  EXPECT_THAT(error(), HasSubstr("self-check"));
}

TEST_F(SelfCheck, FindsATaggedFacetOfNoCell) {
  result_.mesh.triangles.cells[0] = {0, 1, 63};
  EXPECT_THAT(error(), HasSubstr("of none"));
}

TEST_F(SelfCheck, FindsAnUnusedPoint) {
  result_.mesh.points.push_back({1, 2, 3});
  result_.origin.push_back(100);
  EXPECT_THAT(error(), HasSubstr("at every vertex"));
}

TEST_F(SelfCheck, FindsAVertexOffTheSurface) {
  // A boundary vertex pushed out: all cells stay valid.
  for (auto& p : result_.mesh.points)
    if (p == Vec3{3, 3, 3}) p = {3.1, 3.1, 3.1};
  EXPECT_THAT(error(), HasSubstr("surface"));
}

TEST_F(SelfCheck, FindsAVertexOnTheBoundaryThatIsNotTheInputs) {
  result_.origin[0] = static_cast<Vertex>(lattice_.mesh.points.size());
  EXPECT_THAT(error(), HasSubstr("input's vertices"));
}

// A tet is gone, and its facets are tagged as a boundary: all that is left is the volume.
TEST_F(SelfCheck, FindsAChangedVolume) {
  auto& mesh = result_.mesh;
  const Tet tet = mesh.tets.cells.front();
  mesh.tets.cells.erase(mesh.tets.cells.begin());
  mesh.tets.tags.erase(mesh.tets.tags.begin());
  for (const auto& f : TetTopology::triangles) {
    const Triangle triangle{tet[f[0]], tet[f[1]], tet[f[2]]};
    const auto same = std::find_if(mesh.triangles.cells.begin(), mesh.triangles.cells.end(),
                                   [&](const auto& other) { return key_of(other) == key_of(triangle); });
    if (same != mesh.triangles.cells.end()) {
      mesh.triangles.tags.erase(mesh.triangles.tags.begin() + (same - mesh.triangles.cells.begin()));
      mesh.triangles.cells.erase(same);
    } else {
      mesh.triangles.cells.push_back(triangle);
      mesh.triangles.tags.push_back(0);
    }
  }
  EXPECT_THAT(error(), HasSubstr("expected a volume of"));
}

// The quad 0 1 2 3 of a pyramid, and on the other side of a slit a tet with the facet 0 1 3.
TEST(SelfCheckOfASlit, FindsATriangleOnHalfOfAQuad) {
  TetMesh input;
  input.points = {{0, 0, 0.1}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
  input.tets = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 1, 5, 3}};
  input.tet_tags = {1, 1, 1};
  add_missing_boundary_triangles(input, TetAdjacency(input, "test"), 7);
  Extract result;
  result.mesh.points = input.points;
  result.origin = {0, 1, 2, 3, 4, 5};
  const auto add = [](auto& block, const auto& corners, std::int32_t tag) {
    block.cells.push_back(corners);
    block.tags.push_back(tag);
  };
  add(result.mesh.pyramids, std::array<Vertex, 5>{0, 1, 2, 3, 4}, 1);
  add(result.mesh.tets, Tet{0, 1, 5, 3}, 1);
  add(result.mesh.quads, Quad{0, 1, 2, 3}, 7);
  for (const Triangle& triangle :
       {Triangle{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 1, 3}, {0, 1, 5}, {1, 3, 5}, {3, 0, 5}})
    add(result.mesh.triangles, triangle, 7);
  try {
    check_result(result, input, SurfaceTags(input), InputSurface(input, TetAdjacency(input, "mesh")), true);
    FAIL() << "found nothing";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("half of a quad"));
  }
}

TEST_F(SelfCheck, FindsAQuadAgainstTwoTriangles) {
  auto& mesh = result_.mesh;
  const auto pyramid = mesh.pyramids.cells[0];
  mesh.pyramids.cells.erase(mesh.pyramids.cells.begin());
  mesh.pyramids.tags.erase(mesh.pyramids.tags.begin());
  for (const auto& half : triangles_of({pyramid[0], pyramid[1], pyramid[2], pyramid[3]}, 0)) {
    mesh.tets.cells.push_back({half[0], half[1], half[2], pyramid[4]});
    mesh.tets.tags.push_back(1);
  }
  EXPECT_THAT(error(true), HasSubstr("both sides of a quad"));
  EXPECT_EQ(error(false), "");
}

}  // namespace
}  // namespace hexpipe
