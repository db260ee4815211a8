#include "formats/meshes/mesh_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/streams/text_scanner.hpp"
#include "sample_meshes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::string_view read_and_written[] = {"mesh", "msh", "msh-binary", "msh22", "msh22-binary", "vtk", "vtu"};

// MEDIT has no place for qualities, .msh 2.2 goes without, and the others have them only when every cell has one.
MixedMesh as_carried_by(std::string_view format, MixedMesh mesh) {
  if (format == "mesh" || format.starts_with("msh22") || !has_quality(mesh)) drop_quality(mesh);
  return mesh;
}

TEST(MeshFiles, NamesEveryFormatThatItWrites) {
  // Behind these come formats of libraries, where they were built.
  const std::vector<std::string_view> names(mesh_format_names().begin(), mesh_format_names().begin() + 11);
  EXPECT_THAT(names, ::testing::ElementsAre("mesh", "msh", "msh-binary", "msh22", "msh22-binary", "vtk", "vtu", "inp",
                                            "su2", "bdf", "nas"));
  EXPECT_THROW(written(one_cell_of_each_kind(), "stl"), UsageError);
}

TEST(MeshFiles, ReadsBackWhatItWrote) {
  const MixedMesh mesh = one_cell_of_each_kind();
  for (const std::string_view format : read_and_written)
    EXPECT_TRUE(parsed(written(mesh, format)) == as_carried_by(format, mesh)) << format;
}

TEST(MeshFiles, ReadsBackRandomMeshes) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const MixedMesh mesh = random_mesh(seed);
    for (const std::string_view format : read_and_written)
      ASSERT_TRUE(parsed(written(mesh, format)) == as_carried_by(format, mesh)) << format << " seed " << seed;
  }
}

TEST(MeshFiles, ReadsBackMeshesWithoutCells) {
  MixedMesh mesh;
  mesh.points = {{1, 2, 3}};
  for (const std::string_view format : read_and_written) {
    EXPECT_TRUE(parsed(written(mesh, format)) == mesh) << format;
    EXPECT_TRUE(parsed(written(MixedMesh{}, format)) == MixedMesh{}) << format;
  }
}

TEST(MeshFiles, TakesLineEndsOfAnySystem) {
  const MixedMesh mesh = one_cell_of_each_kind();
  for (const std::string_view format : {"mesh", "msh", "msh22", "vtk"}) {
    std::string text;
    for (const char c : written(mesh, format)) text += c == '\n' ? "\r\n" : std::string(1, c);
    EXPECT_TRUE(parsed(text) == as_carried_by(format, mesh)) << format;
  }
}

TEST(MeshFiles, TakesAByteOrderMarkBeforeText) {
  const MixedMesh mesh = one_cell_of_each_kind();
  for (const std::string_view format : {"mesh", "msh", "msh22", "vtk", "vtu"})
    EXPECT_TRUE(parsed("\xef\xbb\xbf" + written(mesh, format)) == as_carried_by(format, mesh)) << format;
}

TEST(MeshFiles, TakesEmptyLinesAndLongCommentsBeforeTheBeginning) {
  const MixedMesh mesh = one_cell_of_each_kind();
  EXPECT_TRUE(parsed("\n\n" + written(mesh, "msh")) == mesh);
  std::string vtu = written(mesh, "vtu");
  vtu = vtu.substr(vtu.find("<VTKFile"));
  EXPECT_TRUE(parsed("\n" + vtu) == mesh);
  EXPECT_TRUE(parsed("<!-- " + std::string(5000, 'x') + " -->\n" + vtu) == mesh);
}

// A prefix that is read must be the whole mesh, but for a list that the format allows to be absent.
TEST(MeshFiles, RejectsEveryTruncatedPrefix) {
  const MixedMesh mesh = one_cell_of_each_kind();
  for (const std::string_view format : read_and_written) {
    const std::string bytes = written(mesh, format);
    const MixedMesh whole = as_carried_by(format, mesh);
    std::vector<std::string> accepted;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string prefix = bytes.substr(0, size);
      const std::string message = message_of_reading(prefix);
      if (!message.empty()) {
        EXPECT_THAT(message, StartsWith("test:"));
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        continue;
      }
      accepted.push_back(bytes.substr(size));
    }
    // The end of the last line, and what may be missing in a legal file.
    if (format == "vtk") {
      // Without cell data a file is complete; it has no tags then.
      ASSERT_EQ(accepted.size(), 1u);
      EXPECT_THAT(accepted[0], StartsWith("CELL_DATA"));
    } else if (format == "mesh") {
      // A cut between sections is told.
      for (const std::string& rest : accepted) {
        std::vector<std::string> warnings;
        Input input = Input::from_memory(bytes.substr(0, bytes.size() - rest.size()), "test");
        read_mixed_mesh(input, nullptr, &warnings);
        EXPECT_EQ(warnings.size(), rest == "\n" ? 0u : 1u) << rest;
        EXPECT_TRUE(rest == "\n" || is_letter(rest[rest.find_first_not_of('\n')])) << rest;
      }
    } else if (format == "msh" || format == "msh-binary") {
      // The quality is a section of its own behind the mesh.
      ASSERT_EQ(accepted.size(), 3u) << format;
      EXPECT_THAT(accepted[0], StartsWith("\n$ElementData"));
      EXPECT_THAT(accepted[1], StartsWith("$ElementData"));
      EXPECT_EQ(accepted[2], "\n");
    } else {
      EXPECT_EQ(accepted, std::vector<std::string>{"\n"}) << format;
    }
  }
}

TEST(MeshFiles, RejectsExtraBytes) {
  for (const std::string_view format : read_and_written) {
    const std::string bytes = written(one_cell_of_each_kind(), format);
    EXPECT_NE(message_of_reading(bytes + "x\n"), "") << format;
    EXPECT_NE(message_of_reading(bytes + bytes), "") << format;
  }
}

// Damaged files are read or refused, but never crash, hang or take memory without bound. Sanitizers watch.
TEST(MeshFiles, SurvivesDamagedFiles) {
  Random random(1);
  for (const std::string_view format : read_and_written) {
    const std::string bytes = written(one_cell_of_each_kind(), format);
    for (int round = 0; round < 1000; ++round) {
      std::string damaged = bytes;
      for (std::uint64_t k = 0; k <= random.below(3); ++k) {
        const std::size_t at = random.below(damaged.size());
        switch (random.below(4)) {
          case 0:
            damaged[at] = static_cast<char>(random.below(256));
            break;
          case 1:
            damaged[at] = static_cast<char>('0' + random.below(10));
            break;
          case 2:
            damaged.erase(at, 1 + random.below(8));
            break;
          default:
            damaged.insert(at, bytes.substr(random.below(bytes.size()), 1 + random.below(8)));
            break;
        }
      }
      const std::string message = message_of_reading(damaged);
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(MeshFiles, RefusesWhatIsNoMesh) {
  EXPECT_THAT(message_of_reading(""), HasSubstr("test:1: expected a mesh"));
  EXPECT_THAT(message_of_reading(" \n"), HasSubstr("expected a mesh"));
  EXPECT_THAT(message_of_reading("solid cube\n"), HasSubstr("found 'solid'"));
  EXPECT_THAT(message_of_reading("<html></html>"), HasSubstr("expected a mesh"));
  EXPECT_THAT(message_of_reading(std::string("\1\0\0\0\3\0\0\0", 8)), HasSubstr("MEDIT's binary format"));
  EXPECT_THAT(message_of_reading("*HEADING\n"), HasSubstr("expected *NODE, found none"));
}

TEST(MeshFiles, RefusesCoordinatesThatAreNotFinite) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.points[3].y = std::numeric_limits<double>::quiet_NaN();
  for (const std::string_view format : read_and_written)
    EXPECT_THAT(message_of_reading(written(mesh, format)), ::testing::ContainsRegex("coordinate|number")) << format;
}

TEST(MeshFiles, RefusesCellsThatRepeatAVertex) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.tets.cells[0][2] = mesh.tets.cells[0][0];
  for (const std::string_view format : read_and_written)
    EXPECT_THAT(message_of_reading(written(mesh, format)),
                HasSubstr("tets[0]: expected 4 different vertices, found 6 twice"))
        << format;
}

TEST(MeshFiles, RefusesVerticesThatAreNotThere) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.points.pop_back();
  for (const std::string_view format : {"mesh", "msh22", "msh22-binary", "vtk", "vtu"})
    EXPECT_THAT(message_of_reading(written(mesh, format)), HasSubstr("expected")) << format;
}

}  // namespace
}  // namespace hexpipe
