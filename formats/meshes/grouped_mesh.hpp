#pragma once
// A mesh as lists of elements of one kind and one group: regions, surfaces. Formats that libraries read and write hold
// it so. Plain data, which the modules of these formats take and give.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/meshes/group_naming.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/streams/group_names.hpp"

namespace hexpipe::formats {

// The side of a cell that a facet lies on.
struct CellSide {
  std::int64_t cell = no_index;  // its place among all cells, in the order of all formats
  CellKind kind = CellKind::tet;
  std::uint8_t facet = 0;  // in the topology's list of triangles or of quads
};

// The number of corners of the element with this code of VTK; 0 for elements that we do not have.
constexpr int corners_of_kind(std::uint8_t vtk) {
  switch (vtk) {
    case 5:
      return 3;
    case 9:
      return 4;
    case 10:
    case 12:
    case 13:
    case 14:
      return corner_count(static_cast<CellKind>(vtk));
    default:
      return 0;
  }
}

// Cells of a region, or facets of a surface.
struct ElementGroup {
  std::uint8_t kind = 0;               // VTK's code
  std::int32_t number = 0;             // of the region or surface
  std::string name;                    // of the region or surface; of a file, it may be empty
  std::vector<Vertex> corners{};       // from 0, one element after the other
  std::vector<Vertex> nodes{};         // of second order, behind the corners; empty if the mesh has none
  std::vector<std::int64_t> places{};  // of each element among all cells or all facets; empty: as they stand
  std::vector<CellSide> sides{};       // of each facet; empty for cells, and of a file

  std::size_t size() const { return corners.size() / static_cast<std::size_t>(corners_of_kind(kind)); }
};

// Groups of one region have one number and one name. In the order of kinds, then of numbers.
struct GroupedMesh {
  std::string name = "mesh";  // of formats whose meshes have names
  std::vector<Vec3> points;
  std::vector<ElementGroup> cells, facets;
  bool second_order = false, full = false;  // as in SecondOrder
};

// The nodes of element i, `order` as node_order() gives it.
inline void list_nodes(const ElementGroup& group, std::size_t i, std::span<const std::size_t> order,
                       std::vector<Vertex>& list) {
  const auto corners = static_cast<std::size_t>(corners_of_kind(group.kind));
  const std::size_t nodes = group.nodes.size() / group.size();
  for (const std::size_t place : order)
    list.push_back(place < corners ? group.corners[i * corners + place] : group.nodes[i * nodes + place - corners]);
}

// The rules of a format for names and numbers.
struct GroupRules {
  NameRules names;
  bool apart = false;                     // no name and no number for a region and a surface
  bool needs_sides = false;               // surfaces are lists of sides of cells
  std::array<const char*, 4> reserved{};  // names that no group may have; null: none
};

// `output`: for messages. Tags of one name are one group, with the number of the first of them. Throws DataError if the
// format needs sides and a facet belongs to no cell.
GroupedMesh grouped(const MixedMesh& mesh, const MeshWriting& writing, const GroupRules& rules,
                    std::string_view output);

// In formats whose blocks have names of their own, regions of several kinds of cells have a block for each: steel_hex,
// steel_tet. These set such names, and take them off again.
void name_blocks_by_kind(GroupedMesh& mesh);
void join_blocks_of_kinds(GroupedMesh& mesh);

// The mesh in a file. A group whose name tells a tag (region_3) gets that tag, and another group its number, or a free
// one if two have the same. The first of several facets with the same corners counts.
MixedMesh ungrouped(GroupedMesh mesh, GroupNames* names);

}  // namespace hexpipe::formats
