#include "formats/meshes/vtk_grid.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/meshes/cell_data.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

// meshio keeps Gmsh's and MEDIT's tags under the second and third, Gmsh writes the fourth.
constexpr std::array<std::string_view, 4> foreign_tag_names{"tag", "gmsh:physical", "medit:ref", "CellEntityIds"};

constexpr std::array dropped_types{vtk_vertex,         vtk_polyvertex, vtk_line,           vtk_polyline,
                                   vtk_quadratic_edge, vtk_cubic_line, vtk_lagrange_curve, vtk_bezier_curve};

struct GridReader {
  VtkGrid& grid;
  std::string_view file;

  [[noreturn]] void fail(std::size_t cell, const std::string& message) const {
    throw DataError::at(file, "cell {}: {}", cell, message);
  }

  std::span<Vertex> corners_of(std::size_t cell) const {
    const std::int64_t begin = cell == 0 ? 0 : grid.ends[cell - 1];
    return std::span(grid.connectivity)
        .subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(grid.ends[cell] - begin));
  }

  void check_arrays() const {
    const std::size_t count = grid.types.size();
    if (grid.ends.size() != count)
      throw DataError::at(file, "expected offsets for {} cells, found {}", count, grid.ends.size());
    std::int64_t last = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (grid.ends[i] < last) fail(i, fmt::format("expected an offset of at least {}, found {}", last, grid.ends[i]));
      last = grid.ends[i];
    }
    if (last != static_cast<std::int64_t>(grid.connectivity.size()))
      throw DataError::at(file, "expected {} corners of cells as the offsets say, found {}", last,
                          grid.connectivity.size());
    for (const auto& [name, tags] : grid.tags) check_cell_data(name, tags.size());
    if (!grid.quality.empty()) check_cell_data(quality_name, grid.quality.size());
  }

  void check_cell_data(std::string_view name, std::size_t size) const {
    if (size != grid.types.size())
      throw DataError::at(file, "expected an entry of cell data {} for each of {} cells, found {}", name,
                          grid.types.size(), size);
  }

  // Pixels and voxels list their corners by coordinates; swapping makes them quads and hexes.
  void turn_pixels_and_voxels() {
    for (std::size_t i = 0; i < grid.types.size(); ++i) {
      const std::span<Vertex> corners = corners_of(i);
      if (grid.types[i] == vtk_pixel && corners.size() == 4) {
        grid.types[i] = vtk_quad;
        std::swap(corners[2], corners[3]);
      } else if (grid.types[i] == vtk_voxel && corners.size() == 8) {
        grid.types[i] = vtk_hex;
        std::swap(corners[2], corners[3]);
        std::swap(corners[6], corners[7]);
      }
    }
  }

  // Polygons and strips become triangles, or a quad, each with the data of its cell.
  void cut_polygons() {
    const auto is_cut = [](std::uint8_t type) { return type == vtk_polygon || type == vtk_triangle_strip; };
    if (std::ranges::none_of(grid.types, is_cut)) return;
    VtkGrid cut;
    const auto add = [&](std::size_t cell, std::uint8_t type, std::span<const Vertex> corners) {
      cut.types.push_back(type);
      cut.connectivity.insert(cut.connectivity.end(), corners.begin(), corners.end());
      cut.ends.push_back(static_cast<std::int64_t>(cut.connectivity.size()));
      for (const auto& [name, tags] : grid.tags) cut.tags[name].push_back(tags[cell]);
      if (!grid.quality.empty()) cut.quality.push_back(grid.quality[cell]);
    };
    for (std::size_t i = 0; i < grid.types.size(); ++i) {
      const std::span<Vertex> corners = corners_of(i);
      if (!is_cut(grid.types[i])) {
        add(i, grid.types[i], corners);
        continue;
      }
      if (corners.size() < 3) fail(i, fmt::format("expected three corners or more, found {}", corners.size()));
      check_corners(i, corners);
      if (grid.types[i] == vtk_polygon && corners.size() == 4)
        add(i, vtk_quad, corners);
      else
        for (const Triangle& t : triangles_of(grid.types[i], corners)) add(i, vtk_triangle, t);
    }
    cut.points = std::move(grid.points);
    grid = std::move(cut);
  }

  std::vector<Triangle> triangles_of(std::uint8_t type, std::span<const Vertex> corners) const {
    std::vector<Triangle> triangles;
    for (std::size_t i = 2; i < corners.size(); ++i)
      if (type == vtk_polygon)
        triangles.push_back({corners[0], corners[i - 1], corners[i]});
      else if (i % 2 == 0)
        triangles.push_back({corners[i - 2], corners[i - 1], corners[i]});
      else
        triangles.push_back({corners[i - 1], corners[i - 2], corners[i]});
    if (type == vtk_polygon) cut_if_concave(grid.points, triangles);
    return triangles;
  }

  void check_corners(std::size_t cell, std::span<const Vertex> corners) const {
    for (const Vertex v : corners)
      if (v < 0 || static_cast<std::size_t>(v) >= grid.points.size())
        fail(cell, fmt::format("expected points from 0 to below {}, found {}", grid.points.size(), v));
  }

  void refuse_other_types(const MixedMesh& mesh) const {
    std::array<bool, 256> known{};
    for (const VtkType type : dropped_types) known[type] = true;
    for_each_block(mesh, [&](const ElementNames& names, const auto&) { known[names.vtk] = true; });
    for (std::size_t i = 0; i < grid.types.size(); ++i)
      if (!known[grid.types[i]])
        fail(i, fmt::format("expected a linear cell of VTK type 5, 9, 10, 12, 13 or 14, found type {}", grid.types[i]));
  }

  const std::vector<std::int32_t>* find_tags(std::string_view own_name) const {
    if (const auto own = grid.tags.find(own_name); own != grid.tags.end()) return &own->second;
    for (const std::string_view name : foreign_tag_names)
      if (const auto foreign = grid.tags.find(name); foreign != grid.tags.end()) return &foreign->second;
    return nullptr;
  }

  template <class Block>
  void take_cells(const ElementNames& names, Block& block) const {
    const auto* const tags = find_tags(names.dimension == 3 ? "region" : "surface");
    const bool with_quality = names.dimension == 3 && !grid.quality.empty();
    const auto count = static_cast<std::size_t>(std::ranges::count(grid.types, names.vtk));
    block.cells.reserve(count);
    block.tags.reserve(count);
    if (with_quality) block.quality.reserve(count);
    for (std::size_t i = 0; i < grid.types.size() && block.size() < count; ++i) {
      if (grid.types[i] != names.vtk) continue;
      take_corners(i, names, block.cells.emplace_back());
      block.tags.push_back(tags != nullptr ? (*tags)[i] : 0);
      if (with_quality) block.quality.push_back(grid.quality[i]);
    }
  }

  template <std::size_t Corners>
  void take_corners(std::size_t cell, const ElementNames& names, std::array<Vertex, Corners>& corners) const {
    const std::span<const Vertex> found = corners_of(cell);
    if (found.size() != Corners)
      fail(cell, fmt::format("expected {} corners of a {}, found {}", Corners, names.one, found.size()));
    check_corners(cell, found);
    std::ranges::copy(found, corners.begin());
    corners = swap_vtk_order(corners);
  }
};

}  // namespace

bool is_vtk_tag_name(std::string_view name) {
  return name == "region" || name == "surface" || std::ranges::find(foreign_tag_names, name) != foreign_tag_names.end();
}

MixedMesh to_mixed_mesh(VtkGrid grid, std::string_view file) {
  GridReader reader{grid, file};
  reader.check_arrays();
  reader.turn_pixels_and_voxels();
  reader.cut_polygons();
  MixedMesh mesh;
  reader.refuse_other_types(mesh);
  for_each_block(mesh, [&](const ElementNames& names, auto& block) { reader.take_cells(names, block); });
  mesh.points = std::move(grid.points);
  return mesh;
}

}  // namespace hexpipe::formats
