#pragma once
// Nodes of second order: in the middles of edges and, in full elements, of quads and of hexes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// VTK's codes of the facets, as CellKind has those of the cells.
inline constexpr std::uint8_t vtk_code_of_triangle = 5, vtk_code_of_quad = 9;

// Where the nodes of an element lie, in VTK's order: in the middles of these edges, then of these quads, then of the
// element itself. The prism's corners are ours, not those of VTK's files.
struct NodePlaces {
  std::span<const LocalEdge> edges;
  std::span<const LocalQuad> quads;
  bool has_middle = false;  // besides its quads

  std::size_t count(bool full) const { return edges.size() + (full ? quads.size() + (has_middle ? 1 : 0) : 0); }
};

namespace node_places {

inline constexpr std::array<LocalEdge, 6> tet_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
inline constexpr std::array<LocalQuad, 6> hex_quads{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 1, 2, 3}, {4, 5, 6, 7}}};
inline constexpr std::array<LocalQuad, 3> prism_quads{{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
inline constexpr std::array<LocalQuad, 1> one_quad{{{0, 1, 2, 3}}};
inline constexpr std::array<LocalEdge, 4> quad_edges{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};

}  // namespace node_places

// By VTK's code of the element with straight edges.
constexpr NodePlaces node_places_of(std::uint8_t vtk) {
  switch (vtk) {
    case static_cast<std::uint8_t>(CellKind::hex):
      return {HexTopology::edges, node_places::hex_quads, true};
    case static_cast<std::uint8_t>(CellKind::prism):
      return {PrismTopology::edges, node_places::prism_quads};
    case static_cast<std::uint8_t>(CellKind::pyramid):
      return {PyramidTopology::edges, node_places::one_quad};
    case static_cast<std::uint8_t>(CellKind::tet):
      return {node_places::tet_edges, {}};
    case vtk_code_of_quad:
      return {node_places::quad_edges, node_places::one_quad};
    default:
      return {std::span(node_places::tet_edges).first<3>(), {}};
  }
}

// The nodes that elements of a mesh have behind their corners. Elements that share an edge or a quad share its node.
struct SecondOrder {
  bool full = false;  // nodes of quads and hexes, too
  Vertex first = 0;   // the points from here on are such nodes, those before are corners
  // The nodes of each element, one after the other, in the order of node_places_of().
  std::vector<Vertex> hexes, prisms, pyramids, tets, triangles, quads;

  const std::vector<Vertex>& of_kind(std::uint8_t vtk) const {
    switch (vtk) {
      case static_cast<std::uint8_t>(CellKind::hex):
        return hexes;
      case static_cast<std::uint8_t>(CellKind::prism):
        return prisms;
      case static_cast<std::uint8_t>(CellKind::pyramid):
        return pyramids;
      case static_cast<std::uint8_t>(CellKind::tet):
        return tets;
      case vtk_code_of_quad:
        return quads;
      default:
        return triangles;
    }
  }
  std::vector<Vertex>& of_kind(std::uint8_t vtk) {
    return const_cast<std::vector<Vertex>&>(static_cast<const SecondOrder&>(*this).of_kind(vtk));
  }
  // The nodes of element i of a kind.
  std::span<const Vertex> of(std::uint8_t vtk, std::size_t i) const {
    const std::size_t count = node_places_of(vtk).count(full);
    return std::span(of_kind(vtk)).subspan(i * count, count);
  }

  bool operator==(const SecondOrder&) const = default;
};

}  // namespace hexpipe
