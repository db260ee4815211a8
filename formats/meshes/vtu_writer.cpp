#include <bit>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/cell_data.hpp"
#include "formats/meshes/element_nodes.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/meshes/vtk_grid.hpp"
#include "formats/meshes/vtu.hpp"
#include "formats/streams/base64.hpp"
#include "formats/streams/number_writer.hpp"

namespace hexpipe::formats {
namespace {

struct DataArray {
  std::string_view name, type;
  int components;
  std::uint64_t bytes;
  std::function<void(Base64Writer&)> write;
};

struct Section {
  std::string_view name, attributes;
  std::vector<DataArray> arrays;
};

constexpr std::string_view numbers_name = "number";
constexpr std::string_view numbers_are_global = " GlobalIds=\"number\"";
constexpr const char* byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

template <class T>
DataArray array_of(std::string_view name, std::string_view type, const std::vector<T>& numbers) {
  return {name, type, 1, numbers.size() * sizeof(T),
          [&numbers](Base64Writer& output) { write_array_bytes(output, numbers); }};
}

Section points_of(const MixedMesh& mesh) {
  DataArray points = array_of("Points", "Float64", mesh.points);
  points.components = 3;
  return {"Points", "", {points}};
}

Section cells_of(const MixedMesh& mesh) {
  const std::uint64_t count = element_count(mesh);
  NodeLister lister(mesh, vtk_nodes);
  std::uint64_t corners = 0;
  for_each_block(
      mesh, [&](const ElementNames& names, const auto& block) { corners += block.size() * lister.count(names.vtk); });
  const auto write_connectivity = [&mesh, lister](Base64Writer& output) mutable {
    for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
      for (std::size_t i = 0; i < block.size(); ++i)
        for (const Vertex v : lister.nodes(names.vtk, block, i)) write_bytes(output, v);
    });
  };
  const auto write_offsets = [&mesh, lister](Base64Writer& output) {
    std::int64_t end = 0;
    for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
      for (std::size_t i = 0; i < block.size(); ++i)
        write_bytes(output, end += static_cast<std::int64_t>(lister.count(names.vtk)));
    });
  };
  const auto write_types = [&mesh](Base64Writer& output) {
    for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
      for (std::size_t i = 0; i < block.size(); ++i) write_bytes(output, names.vtk_of(mesh));
    });
  };
  return {"Cells",
          "",
          {{"connectivity", "Int32", 1, corners * sizeof(Vertex), write_connectivity},
           {"offsets", "Int64", 1, count * sizeof(std::int64_t), write_offsets},
           {"types", "UInt8", 1, count, write_types}}};
}

Section cell_data_of(const CellData& data) {
  Section section{"CellData",
                  "",
                  {array_of("region", "Int32", data.region), array_of("surface", "Int32", data.surface),
                   array_of("kind", "UInt8", data.kind)}};
  if (!data.quality.empty()) section.arrays.push_back(array_of(quality_name, "Float64", data.quality));
  return section;
}

// A name of a file as the value of an attribute.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

// Every array stands in its own element, its length and its numbers in one run of base64. The meshio of Debian 13
// cannot read data that are appended behind all elements: its Python does not stop at the padding of an array.
void write_section(const Section& section, Output& output) {
  output.print("      <{}{}>\n", section.name, section.attributes);
  for (const DataArray& array : section.arrays) {
    // An array has one component unless it says otherwise; meshio makes a column of an array that says 1.
    const std::string components =
        array.components == 1 ? "" : fmt::format("NumberOfComponents=\"{}\" ", array.components);
    output.print("        <DataArray type=\"{}\" Name=\"{}\" {}format=\"binary\">\n", array.type, array.name,
                 components);
    Base64Writer data(output);
    write_bytes(data, array.bytes);
    array.write(data);
    data.end();
    output.print("\n        </DataArray>\n");
  }
  output.print("      </{}>\n", section.name);
}

void write_sections(const MixedMesh& mesh, const std::vector<Section>& sections, Output& output) {
  output.print(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      byte_order, mesh.points.size(), element_count(mesh));
  for (const Section& section : sections) write_section(section, output);
  output.print("    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n");
}

}  // namespace

void write_vtu(const MixedMesh& mesh, Output& output) {
  const CellData data = cell_data(mesh);
  write_sections(mesh, {points_of(mesh), cells_of(mesh), cell_data_of(data)}, output);
}

void write_vtu_piece(const MixedMesh& mesh, const std::vector<std::int64_t>& point_number, Output& output) {
  const CellData data = cell_data(mesh);
  const Section numbers{"PointData", numbers_are_global, {array_of(numbers_name, "Int64", point_number)}};
  write_sections(mesh, {numbers, points_of(mesh), cells_of(mesh), cell_data_of(data)}, output);
}

void write_pvtu(const std::vector<std::string>& pieces, Output& output) {
  const auto array = [&](const char* type, std::string_view name, const char* more = "") {
    output.print("      <PDataArray type=\"{}\" Name=\"{}\"{}/>\n", type, name, more);
  };
  output.print(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "  <PUnstructuredGrid GhostLevel=\"0\">\n    <PPointData{}>\n",
      byte_order, numbers_are_global);
  array("Int64", numbers_name);
  output.print("    </PPointData>\n    <PCellData>\n");
  array("Int32", "region");
  array("Int32", "surface");
  array("UInt8", "kind");
  array("Float64", quality_name);
  output.print("    </PCellData>\n    <PPoints>\n");
  array("Float64", "Points", " NumberOfComponents=\"3\"");
  output.print("    </PPoints>\n");
  for (const std::string& piece : pieces) output.print("    <Piece Source=\"{}\"/>\n", escaped(piece));
  output.print("  </PUnstructuredGrid>\n</VTKFile>\n");
}

}  // namespace hexpipe::formats
