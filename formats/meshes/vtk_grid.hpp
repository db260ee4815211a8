#pragma once
// Shared by the two VTK formats: an unstructured grid as arrays, with the cell data that hold tags and qualities.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::formats {

// VTK's numbers of the cells that readers turn into ours, or drop. CellKind has those of ours.
enum VtkType : std::uint8_t {
  vtk_vertex = 1,
  vtk_polyvertex = 2,
  vtk_line = 3,
  vtk_polyline = 4,
  vtk_triangle = 5,
  vtk_triangle_strip = 6,
  vtk_polygon = 7,
  vtk_pixel = 8,
  vtk_quad = 9,
  vtk_voxel = 11,
  vtk_hex = 12,
  vtk_quadratic_edge = 21,
  vtk_cubic_line = 35,
  vtk_lagrange_curve = 68,
  vtk_bezier_curve = 75,
};

// Cells of all kinds in one list, as the files hold them.
struct VtkGrid {
  std::vector<Vec3> points;
  std::vector<std::uint8_t> types;
  std::vector<std::int64_t> ends;  // for each cell, where its corners end in `connectivity`
  std::vector<Vertex> connectivity;
  std::map<std::string, std::vector<std::int32_t>, std::less<>> tags;  // cell data by name, see is_vtk_tag_name
  std::vector<double> quality;                                         // the cell data of this name, or empty
};

// Converts the corners of an element from our order to VTK's, or back. Only the wedge differs: VTK lists its first
// triangle with the normal pointing out. Up to version 9.6, VTK computes faces and volumes that way, and Gmsh and
// meshio write it.
template <std::size_t Corners>
constexpr std::array<Vertex, Corners> swap_vtk_order(std::array<Vertex, Corners> corners) {
  if constexpr (Corners == 6) {
    std::swap(corners[1], corners[2]);
    std::swap(corners[4], corners[5]);
  }
  return corners;
}

// True for the names of cell data that a reader puts into VtkGrid::tags.
bool is_vtk_tag_name(std::string_view name);

// Sorts the cells by kind. Drops points and lines; pixels and voxels become quads and hexes, polygons and strips
// triangles and quads. Regions come from the cell
// data `region`, surface tags from `surface`; without these, both come from the first name that other programs use and
// that is there. Throws DataError naming `file` on other cells, or when the arrays contradict each other.
MixedMesh to_mixed_mesh(VtkGrid grid, std::string_view file);

}  // namespace hexpipe::formats
