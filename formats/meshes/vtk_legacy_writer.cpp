#include "formats/meshes/cell_data.hpp"
#include "formats/meshes/element_nodes.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/meshes/vtk_legacy.hpp"
#include "formats/streams/number_writer.hpp"

namespace hexpipe::formats {
namespace {

void write_cells(const MixedMesh& mesh, Output& output) {
  LineWriter line(output);
  NodeLister lister(mesh, vtk_nodes);
  std::size_t numbers = 0;
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    numbers += block.size() * (1 + lister.count(names.vtk));
  });
  output.print("CELLS {} {}\n", element_count(mesh), numbers);
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      line << lister.count(names.vtk);
      for (const Vertex v : lister.nodes(names.vtk, block, i)) line << v;
      line.end_line();
    }
  });
  output.print("CELL_TYPES {}\n", element_count(mesh));
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) output.print("{}\n", names.vtk_of(mesh));
  });
}

template <class T>
void write_array(std::string_view name, std::string_view type, const std::vector<T>& numbers, Output& output) {
  output.print("{} 1 {} {}\n", name, numbers.size(), type);
  LineWriter line(output);
  for (const T number : numbers) {
    line << number;
    line.end_line();
  }
}

}  // namespace

void write_vtk_legacy(const MixedMesh& mesh, Output& output) {
  LineWriter line(output);
  output.print("# vtk DataFile Version 3.0\nhexpipe mesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
               mesh.points.size());
  for (const Vec3& p : mesh.points) {
    line << p.x << p.y << p.z;
    line.end_line();
  }
  write_cells(mesh, output);
  const CellData data = cell_data(mesh);
  output.print("CELL_DATA {}\nFIELD FieldData {}\n", element_count(mesh), data.quality.empty() ? 3 : 4);
  write_array("region", "int", data.region, output);
  write_array("surface", "int", data.surface, output);
  write_array("kind", "int", data.kind, output);
  if (!data.quality.empty()) write_array(quality_name, "double", data.quality, output);
}

}  // namespace hexpipe::formats
