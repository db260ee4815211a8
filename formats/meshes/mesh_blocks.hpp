#pragma once
// The blocks of a mixed mesh, in the order in which every file lists them, and the names of their elements in each
// format.

#include <array>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::formats {

struct ElementNames {
  const char* one;    // in messages
  const char* medit;  // keyword
  int dimension;      // 3: a cell, whose tag is a region; 2: a facet, whose tag is a surface
  std::uint8_t vtk;   // cell type
  std::uint8_t gmsh;  // element type
  // The same of second order: with nodes on edges alone, and full. VTK has no pyramid of 14 nodes.
  std::array<std::uint8_t, 2> vtk_second, gmsh_second;

  std::uint8_t vtk_of(const MixedMesh& mesh) const {
    return mesh.second_order ? vtk_second[mesh.second_order->full ? 1 : 0] : vtk;
  }
  std::uint8_t gmsh_of(const MixedMesh& mesh) const {
    return mesh.second_order ? gmsh_second[mesh.second_order->full ? 1 : 0] : gmsh;
  }
};

inline constexpr ElementNames hex_names{"hex", "Hexahedra", 3, 12, 5, {25, 29}, {17, 12}};
inline constexpr ElementNames prism_names{"prism", "Prisms", 3, 13, 6, {26, 32}, {18, 13}};
inline constexpr ElementNames pyramid_names{"pyramid", "Pyramids", 3, 14, 7, {27, 27}, {19, 14}};
inline constexpr ElementNames tet_names{"tet", "Tetrahedra", 3, 10, 4, {24, 24}, {11, 11}};
inline constexpr ElementNames triangle_names{"triangle", "Triangles", 2, 5, 2, {22, 22}, {9, 9}};
inline constexpr ElementNames quad_names{"quad", "Quadrilaterals", 2, 9, 3, {23, 28}, {16, 10}};

// The number of corners of the elements of a block.
template <class Block>
inline constexpr int corners_of_block =
    std::tuple_size_v<typename std::remove_cvref_t<decltype(Block::cells)>::value_type>;

// Calls visit(names, block) for the four blocks of cells and then the two of facets.
template <class Mesh, class Visitor>
void for_each_block(Mesh& mesh, Visitor&& visit) {
  visit(hex_names, mesh.hexes);
  visit(prism_names, mesh.prisms);
  visit(pyramid_names, mesh.pyramids);
  visit(tet_names, mesh.tets);
  visit(triangle_names, mesh.triangles);
  visit(quad_names, mesh.quads);
}

inline std::size_t element_count(const MixedMesh& mesh) {
  return mesh.cell_count() + mesh.triangles.size() + mesh.quads.size();
}

// True when there are cells and every one has a quality: then files have it.
inline bool has_quality(const MixedMesh& mesh) {
  bool all = mesh.cell_count() > 0;
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    if (names.dimension == 3 && block.quality.size() != block.size()) all = false;
  });
  return all;
}

}  // namespace hexpipe::formats
