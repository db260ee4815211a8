#include "formats/points/size_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "formats/pipeline/npy.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe {
using namespace formats;
using namespace pipeline;
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SizeList sizes_of(const std::string& bytes) {
  Input input = Input::from_memory(bytes, "sizes");
  return read_sizes(input);
}

SurfaceSoup surface_of(const std::string& bytes) {
  Input input = Input::from_memory(bytes, "part");
  return read_surface(input);
}

void expect_error(const std::string& bytes, const std::string& message) {
  EXPECT_THAT([&] { sizes_of(bytes); }, ThrowsMessage<DataError>(HasSubstr(message))) << bytes;
}

std::string npy(const std::vector<std::uint64_t>& shape, const std::vector<double>& numbers) {
  return npy_header({{'f', 8}, shape}) +
         std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
}

const std::string msh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n9 7 7 7\n$EndNodes\n"
    "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

std::string node_data(int components, const std::string& rows) {
  return fmt::format("$NodeData\n1\n\"size\"\n1\n0\n3\n0\n{}\n4\n{}$EndNodeData\n", components, rows);
}

TEST(SizeFiles, ReadPlacesWithSizes) {
  const SizeList list = sizes_of("# x y z size\n0 0 0 0.5\n1 2 3 .25 # here\n");
  EXPECT_EQ(list.points, (std::vector<Vec3>{{0, 0, 0}, {1, 2, 3}}));
  EXPECT_EQ(list.sizes, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(list.simplices, (std::vector<std::array<Vertex, 4>>{{0, -1, -1, -1}, {1, -1, -1, -1}}));
  const SizeList same = sizes_of(npy({2, 4}, {0, 0, 0, 0.5, 1, 2, 3, 0.25}));
  EXPECT_EQ(same.points, list.points);
  EXPECT_EQ(same.sizes, list.sizes);
}

TEST(SizeFiles, GiveSizesToTheVerticesOfASurface) {
  // The fourth vertex is not used, the fifth is the first again.
  const SurfaceSoup surface =
      surface_of("OFF\n6 4 0\n0 0 0\n1 0 0\n0 1 0\n9 9 9\n0 0 0\n0 0 1\n3 0 2 1\n3 0 1 5\n3 1 2 5\n3 4 5 2\n");
  for (const std::string& bytes : {std::string("1\n2\n3\n4\n5\n6\n"), npy({6}, {1, 2, 3, 4, 5, 6})}) {
    const SizeList list = on_surface(sizes_of(bytes), surface);
    EXPECT_EQ(list.points, surface.points);
    EXPECT_EQ(list.sizes, (std::vector<double>{1, 3, 2, 6}));  // in the order of first use
    EXPECT_EQ(list.simplices.size(), 4u);
  }
  EXPECT_THAT([&] { on_surface(sizes_of("1\n2\n"), surface); },
              ThrowsMessage<DataError>(HasSubstr("sizes: expected 6 sizes, one for each vertex of part, found 2")));
  const SurfaceSoup stl = surface_of(
      "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid a\n");
  EXPECT_THAT([&] { on_surface(sizes_of("1\n2\n3\n"), stl); },
              ThrowsMessage<DataError>(HasSubstr("expected sizes with their places")));
}

TEST(SizeFiles, ReadABackgroundMesh) {
  const std::string good = msh + node_data(3, "1 0 0 0\n2 0 0 0\n3 0 0 0\n4 0 0 0\n") +
                           node_data(1, "4 0.4\n2 0.2\n3 0.3\n1 0.1\n") + node_data(1, "1 9\n2 9\n3 9\n4 9\n");
  const SizeList list = sizes_of(good);
  // The fifth node is in no tet, and has no size.
  EXPECT_EQ(list.sizes, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(list.points.size(), 4u);
  EXPECT_EQ(list.simplices, (std::vector<std::array<Vertex, 4>>{{0, 1, 2, 3}}));
  expect_error(msh, "expected $NodeData with one component, found none");
  expect_error(msh + node_data(1, "1 1\n2 1\n3 1\n8 1\n"), "found '8'");
  expect_error(msh + node_data(1, "1 1\n2 1\n3 1\n3 1\n"), "expected a positive size at every node");
  expect_error(msh + node_data(1, "1 1\n2 1\n3 1\n4 0\n"),
               "expected a positive size at every node of $NodeData, found 0");
}

// The numbers of a binary file may be any.
TEST(SizeFiles, RefuseABackgroundMeshThatIsNone) {
  const std::string sizes = node_data(1, "1 1\n2 1\n3 1\n4 1\n");
  const auto expect_defect = [&](std::string_view from, std::string_view to, const std::string& message) {
    std::string changed = msh;
    expect_error(changed.replace(changed.find(from), from.size(), to) + sizes, message);
  };
  expect_defect("4 0 0 1\n", "4 0 0 1e300\n", "sizes: points[3]: expected coordinates up to 1e+50, found 0 0 1e+300");
  expect_defect("1 1 2 3 4\n", "1 1 2 3 3\n", "sizes: tets[0]: expected 4 different vertices, found 2 twice");
}

TEST(SizeFiles, RefuseATextThatMayBeCutOffWithinANumber) {
  expect_error("1\n0.5", "sizes: expected the last line to have an end, found none; is the file cut off?");
  expect_error("0 0 0 1\n1 0 0 0.5", "expected the last line to have an end");
}

TEST(SizeFiles, TakeAByteOrderMarkBeforeText) {
  EXPECT_EQ(sizes_of("\xef\xbb\xbf"
                     "1\n0.5\n")
                .sizes,
            (std::vector<double>{1, 0.5}));
  const std::string background = msh + node_data(1, "1 1\n2 1\n3 1\n4 1\n");
  EXPECT_EQ(sizes_of("\xef\xbb\xbf" + background).simplices.size(), 1u);
}

TEST(SizeFiles, NameWhatIsWrong) {
  expect_error("0 0 0 1\n1e300 0 0 0.5\n", "sizes:2: expected coordinates up to 1e+50, found 1e+300 0 0");
  expect_error("", "sizes: expected sizes, found none");
  expect_error("1\n0\n", "sizes:2: expected a positive size, found 0");
  expect_error("1\n-1\n", "sizes:2: expected a positive size, found -1");
  expect_error("1\nx\n", "sizes:2: expected a size, or a place and its size, found 'x'");
  expect_error("0 0 0 1\n0 0 0\n", "sizes:2: expected a size, found the end of the line");
  expect_error("0 0 0 1\n0 0 0 1 1\n", "sizes:2: expected the end of the line, found '1'");
  expect_error("1\n1 2\n", "sizes:2: expected the end of the line");
  expect_error(npy({2, 3}, {1, 1, 1, 1, 1, 1}), "expected an array of floats");
  expect_error(npy({3}, {1, 1}), "expected 3 rows of 8 bytes, found 16 bytes");
  expect_error(npy({2}, {1, -1}), "row 2: expected coordinates up to 1e+50 and a positive size");
}

}  // namespace
}  // namespace hexpipe
