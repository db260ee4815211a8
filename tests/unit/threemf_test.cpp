#include "formats/surfaces/threemf.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

using ZipParts = std::vector<std::pair<std::string, std::string>>;  // their names and texts

std::string zip_of(const ZipParts& parts) {
  std::string zip(1 << 20, '\0');
  std::size_t used = 0;
  archive* const out = archive_write_new();
  archive_write_set_format_zip(out);
  archive_write_open_memory(out, zip.data(), zip.size(), &used);
  for (const auto& [name, text] : parts) {
    archive_entry* const entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(text.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_write_header(out, entry);
    archive_write_data(out, text.data(), text.size());
    archive_entry_free(entry);
  }
  archive_write_free(out);
  zip.resize(used);
  return zip;
}

SurfaceSoup read_parts(const ZipParts& parts) {
  return read_3mf(zip_of(parts), "part.3mf");
}

SurfaceSoup read_model(const std::string& model) {
  return read_parts({{"3D/3dmodel.model", model}});
}

std::string error_of_parts(const ZipParts& parts) {
  try {
    read_parts(parts);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_of_model(const std::string& model) {
  return error_of_parts({{"3D/3dmodel.model", model}});
}

// Triangles have the attributes given.
std::string tet(const std::vector<std::string>& of_triangles = {}, const std::string& first_x = "0") {
  std::string text = fmt::format(
      "<mesh><vertices><vertex x=\"{}\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" "
      "z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices>\n<triangles>",
      first_x);
  constexpr const char* corners[] = {"v1=\"0\" v2=\"2\" v3=\"1\"", "v1=\"0\" v2=\"1\" v3=\"3\"",
                                     "v1=\"1\" v2=\"2\" v3=\"3\"", "v1=\"0\" v2=\"3\" v3=\"2\""};
  for (std::size_t i = 0; i < 4; ++i)
    text += fmt::format("<triangle {} {}/>", corners[i], i < of_triangles.size() ? of_triangles[i] : "");
  return text + "</triangles></mesh>";
}

std::string object(int id, const std::string& content, const std::string& attributes = "") {
  return fmt::format("<object id=\"{}\" {}>{}</object>", id, attributes, content);
}

std::string item(int id, const std::string& attributes = "") {
  return fmt::format("<item objectid=\"{}\" {}/>", id, attributes);
}

std::string model(const std::string& resources, const std::string& build, const std::string& attributes = "") {
  return fmt::format("<model {}>\n<resources>{}</resources>\n<build>{}</build></model>", attributes, resources, build);
}

constexpr const char* colours =
    "<m:colorgroup id=\"5\"><m:color color=\"#FF0000\"/><m:color color=\"#00FF00\"/></m:colorgroup>";

TEST(Threemf, ObjectsOfTypeOtherAreLeftOutWithAWarning) {
  const std::string settings = "<config><part id=\"2\" subtype=\"negative_part\"/></config>";
  const ZipParts parts{
      {"3D/3dmodel.model", model(object(1, tet()) + object(2, tet(), "type=\"other\""), item(1) + item(2) + item(2))},
      {"Metadata/model_settings.config", settings}};
  const SurfaceSoup soup = read_parts(parts);
  EXPECT_EQ(soup.triangles.size(), 4u);
  EXPECT_THAT(soup.warnings,
              ElementsAre("part.3mf: 2 objects of type \"other\", as slicers' modifiers and negative parts are, are "
                          "left out"));
}

TEST(Threemf, PartsThatSlicersKnowAsModifiersAreTold) {
  for (const auto& [name, word] : {std::pair("Metadata/model_settings.config", "modifier_part"),
                                   std::pair("Metadata/model_settings.config", "negative_part"),
                                   std::pair("Metadata/Slic3r_PE_model.config", "NegativeVolume"),
                                   std::pair("Metadata/Slic3r_PE_model.config", "ParameterModifier")}) {
    const std::string root = model(object(1, tet()), item(1));
    const auto warnings = [&](const std::string& settings) {
      return read_parts({{"3D/3dmodel.model", root}, {name, settings}}).warnings;
    };
    EXPECT_THAT(warnings(fmt::format("<config value=\"{}\"/>", word)),
                ElementsAre("part.3mf: has modifiers or negative parts of a slicer; they are read as bodies"));
    EXPECT_THAT(warnings("<config value=\"normal_part\"/>"), IsEmpty());
  }
}

TEST(Threemf, FilesThatNeedMoreThanMeshesAreRefused) {
  const auto error_with = [](const std::string& attributes) {
    return error_of_model(model(object(1, tet()), item(1), attributes));
  };
  const std::string known = "http://schemas.microsoft.com/3dmanufacturing/";
  EXPECT_EQ(error_with("requiredextensions=\"b\" xmlns:b=\"" + known + "beamlattice/2017/02\""),
            "part.3mf: expected a 3MF file of meshes alone, found one that needs the extension 'beamlattice/2017/02'");
  EXPECT_THAT(
      error_with(
          "requiredextensions=\"b\" xmlns:b=\"http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07\""),
      HasSubstr("needs the extension 'booleanoperations/2023/07'"));
  EXPECT_THAT(error_with("requiredextensions=\"p x\" xmlns:p=\"" + known + "production/2015/06\""),
              HasSubstr("needs the extension 'x'"));
  EXPECT_EQ(error_with("requiredextensions=\" p  m \" xmlns:p=\"" + known + "production/2015/06\" xmlns:m=\"" + known +
                       "material/2015/02\""),
            "no error");
  EXPECT_EQ(error_of_model(model(object(1, "<beams/>"), item(1))),
            "part.3mf: in 3D/3dmodel.model, line 2: expected a mesh or components");
}

TEST(Threemf, CopiesOfAnObjectAreGroupsOfTheirOwn) {
  const std::string parts =
      "<components><component objectid=\"1\"/><component objectid=\"1\" "
      "transform=\"-1 0 0 0 1 0 0 0 1 -1 0 0\"/></components>";
  const SurfaceSoup soup = read_model(model(
      colours + object(1, tet({"pid=\"5\" p1=\"1\""}), "name=\"tet\"") + object(2, parts), item(2), "unit=\"meter\""));
  EXPECT_THAT(soup.tags, ElementsAre(1, 2, 2, 2, 3, 4, 4, 4));
  EXPECT_THAT(soup.names.surfaces,
              ElementsAre(Pair(1, "tet #00FF00"), Pair(2, "tet"), Pair(3, "tet #00FF00"), Pair(4, "tet")));
  EXPECT_EQ(soup.points[5].x, -2000);
  EXPECT_EQ(soup.triangles[4], (Triangle{4, 5, 6}));
  EXPECT_THAT(soup.places, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST(Threemf, ComponentsThatPlaceTooMuchAreRefused) {
  const auto parts = [](int id, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += fmt::format("<component objectid=\"{}\"/>", id);
    return "<components>" + text + "</components>";
  };
  const std::string expected = "part.3mf: expected at most 100000 objects in 32 levels of components, found more";
  EXPECT_EQ(error_of_model(model(object(1, parts(1, 1)), item(1))), expected);
  EXPECT_EQ(error_of_model(model(object(1, tet()) + object(2, parts(1, 400)) + object(3, parts(2, 400)), item(3))),
            expected);
}

TEST(Threemf, GradientsBelongToTheirObject) {
  const SurfaceSoup soup = read_model(
      model(colours + object(1,
                             tet({"pid=\"5\" p1=\"1\" p2=\"0\" p3=\"1\"", "pid=\"5\" p1=\"1\" p2=\"1\" p3=\"1\"",
                                  "pid=\"5\" p1=\"1\"", "pid=\"5\" p1=\"0\""}),
                             "name=\"a\" pid=\"5\" pindex=\"0\""),
            item(1)));
  EXPECT_THAT(soup.tags, ElementsAre(1, 2, 2, 1));
  EXPECT_THAT(soup.names.surfaces, ElementsAre(Pair(1, "a"), Pair(2, "a #00FF00")));
}

TEST(Threemf, MessagesShowWordsOfTheFileCutAndPrintable) {
  const std::string place = "part.3mf: in 3D/3dmodel.model, line 2: ", start = place + "expected a number as x, found ";
  EXPECT_EQ(error_of_model(model(object(1, tet({}, std::string(1000, 'z'))), item(1))),
            start + "'" + std::string(40, 'z') + "...'");
  EXPECT_EQ(error_of_model(model(object(1, tet({}, "\x1b[31m")), item(1))), start + "'?[31m'");
  EXPECT_EQ(error_of_model(model(object(1, tet({}, "")), item(1))), start + "none");
  EXPECT_THAT(error_of_model(model(object(1, tet()), item(1), "unit=\"\x1b[31m\"")), HasSubstr("unit, found '?[31m'"));
  EXPECT_EQ(error_of_model(model(object(1, tet()), "<item objectid=\"" + std::string(99, 'q') + "\"/>")),
            "part.3mf: in 3D/3dmodel.model, line 4: expected an object '" + std::string(40, 'q') + "...', found none");
  EXPECT_THAT(error_of_model(model(object(1, tet()), "<item/>")), HasSubstr("expected an objectid, found none"));
}

TEST(Threemf, NumbersMayHaveBlanksAndAPlus) {
  EXPECT_EQ(error_of_model(model(object(1, tet({}, " +0\n")), item(1))), "no error");
  for (const char* const wrong : {"+-0", "++0", "+", "0,5", "0 0", "nan", "1e999"})
    EXPECT_THAT(error_of_model(model(object(1, tet({}, wrong)), item(1))), HasSubstr("expected a number as x"));
  const auto with_transform = [](const std::string& transform) {
    return error_of_model(model(object(1, tet()), item(1, "transform=\"" + transform + "\"")));
  };
  EXPECT_EQ(with_transform(" +1 0 0 0 1 0\t0 0 1 0 0 0 "), "no error");
  EXPECT_THAT(with_transform("1 0 0 0 1 0 0 0 1 0 0"), HasSubstr("line 4: expected twelve numbers in transform"));
  EXPECT_THAT(with_transform("1 0 0 0 1 0 0 0 1 0 0 0 7"),
              HasSubstr("expected twelve numbers in transform, found more"));
}

TEST(Threemf, NamesOfPartsMayDifferInCaseAndBeEncoded) {
  const std::string root = model(object(1, tet()), item(1));
  const auto with_root = [&](const std::string& name, const std::string& target) {
    return error_of_parts({{"_rels/.rels", "<Relationships><Relationship Target=\"" + target +
                                               "\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/"
                                               "3dmodel\"/></Relationships>"},
                           {name, root}});
  };
  EXPECT_EQ(with_root("3D/3DModel.model", "/3D/3dmodel.model"), "no error");
  EXPECT_EQ(with_root("3D/my model.model", "/3D/my%20model.model"), "no error");
  EXPECT_EQ(with_root("3D/a.model", "/3D/b.model"), "part.3mf: expected a surface, found a 3MF file without a model");
  EXPECT_EQ(error_of_parts({{"3D/3dmodel.model", model("", item(1, "p:path=\"/3D/Knob.model\""))}}),
            "part.3mf: expected '/3D/Knob.model' in the 3MF file, found none");
  EXPECT_EQ(
      error_of_parts({{"3D/3DMODEL.model", "<model><resources/><build>\n<item objectid=\"7\"/></build></model>"}}),
      "part.3mf: in 3D/3DMODEL.model, line 2: expected an object '7', found none");
}

}  // namespace
}  // namespace hexpipe
