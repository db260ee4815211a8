#pragma once
// The order in which a format lists the nodes of an element. Header only: the modules of formats that libraries write
// need it, too.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::formats {

// The nodes of each kind of element as a format lists them: a node is named by the corners that it lies between, * is
// the middle of the element. What a format lacks is left out. An element of first order has the single corners alone,
// and one without nodes on quads has the corners and the edges.
struct NodeLists {
  std::string_view hex, prism, pyramid, tet, triangle = "0 1 2 01 12 20", quad = "0 1 2 3 01 12 23 30 0123";

  constexpr std::string_view of(std::uint8_t vtk) const {
    switch (vtk) {
      case static_cast<std::uint8_t>(CellKind::hex):
        return hex;
      case static_cast<std::uint8_t>(CellKind::prism):
        return prism;
      case static_cast<std::uint8_t>(CellKind::pyramid):
        return pyramid;
      case static_cast<std::uint8_t>(CellKind::tet):
        return tet;
      case vtk_code_of_quad:
        return quad;
      default:
        return triangle;
    }
  }
};

// Up to version 9.6, VTK's wedge has the normal of its first triangle pointing out.
inline constexpr NodeLists vtk_nodes{
    .hex = "0 1 2 3 4 5 6 7 01 12 23 30 45 56 67 74 04 15 26 37 0473 1265 0154 3762 0123 4567 *",
    .prism = "0 2 1 3 5 4 02 21 10 35 54 43 03 25 14 0253 2145 1034",
    .pyramid = "0 1 2 3 4 01 12 23 30 04 14 24 34",
    .tet = "0 1 2 3 01 12 20 03 13 23"};

inline constexpr NodeLists gmsh_nodes{
    .hex = "0 1 2 3 4 5 6 7 01 03 04 12 15 23 26 37 45 47 56 67 0321 0154 0473 1265 2376 4567 *",
    .prism = "0 1 2 3 4 5 01 02 03 12 14 25 34 35 45 0143 0352 1254",
    .pyramid = "0 1 2 3 4 01 03 04 12 14 23 24 34 0321",
    .tet = "0 1 2 3 01 12 20 30 32 31"};

inline constexpr NodeLists abaqus_nodes{.hex = "0 1 2 3 4 5 6 7 01 12 23 30 45 56 67 74 04 15 26 37",
                                        .prism = "0 1 2 3 4 5 01 12 20 34 45 53 03 14 25",
                                        .pyramid = "0 1 2 3 4 01 12 23 30 04 14 24 34",
                                        .tet = "0 1 2 3 01 12 20 03 13 23"};

inline constexpr NodeLists exodus_nodes{
    .hex = "0 1 2 3 4 5 6 7 01 12 23 30 04 15 26 37 45 56 67 74 * 0123 4567 0473 1265 0154 3762",
    .prism = "0 1 2 3 4 5 01 12 20 03 14 25 34 45 53 0143 1254 2035",
    .pyramid = "0 1 2 3 4 01 12 23 30 04 14 24 34 0123",
    .tet = "0 1 2 3 01 12 20 03 13 23"};

// MED's cells are seen from the other side.
inline constexpr NodeLists med_nodes{
    .hex = "0 3 2 1 4 7 6 5 03 32 21 10 47 76 65 54 04 37 26 15 0321 0374 3267 2156 1045 4567 *",
    .prism = "0 2 1 3 5 4 02 21 10 35 54 43 03 25 14 0253 2145 1034",
    .pyramid = "0 3 2 1 4 03 32 21 10 04 34 24 14",
    .tet = "0 2 1 3 02 21 10 03 23 13"};

// For each node of the format its place among ours: corners, then the nodes of second order if the element has them.
inline std::vector<std::size_t> node_order(const NodeLists& lists, std::uint8_t vtk, bool second_order, bool full) {
  const NodePlaces places = node_places_of(vtk);
  std::vector<std::size_t> order;
  std::string_view list = lists.of(vtk);
  const std::size_t corners = vtk == vtk_code_of_triangle ? 3
                              : vtk == vtk_code_of_quad   ? 4
                                                          : corner_count(static_cast<CellKind>(vtk));
  const auto same = [](std::string_view token, auto corner_list) {
    return token.size() == corner_list.size() && std::ranges::all_of(token, [&](char c) {
             return std::ranges::find(corner_list, static_cast<std::uint8_t>(c - '0')) != corner_list.end();
           });
  };
  const auto place = [&](std::string_view token, auto between) {
    return static_cast<std::size_t>(std::ranges::find_if(between, [&](const auto& at) { return same(token, at); }) -
                                    between.begin());
  };
  while (!list.empty()) {
    const std::string_view token = list.substr(0, list.find(' '));
    list.remove_prefix(std::min(list.size(), token.size() + 1));
    if (token.size() == 1 && token != "*")
      order.push_back(static_cast<std::size_t>(token[0] - '0'));
    else if (token.size() == 2 && second_order)
      order.push_back(corners + place(token, places.edges));
    else if (token.size() == 4 && second_order && full)
      order.push_back(corners + places.edges.size() + place(token, places.quads));
    else if (token == "*" && second_order && full)
      order.push_back(corners + places.edges.size() + places.quads.size());
  }
  return order;
}

// Lists the nodes of elements of a mesh in the order of a format.
class NodeLister {
 public:
  NodeLister(const MixedMesh& mesh, const NodeLists& lists) : mesh_(mesh) {
    const bool second = mesh.second_order.has_value(), full = second && mesh.second_order->full;
    for (const std::uint8_t vtk : kinds) orders_[index(vtk)] = node_order(lists, vtk, second, full);
  }

  std::size_t count(std::uint8_t vtk) const { return orders_[index(vtk)].size(); }

  // The nodes of element i of a block, until the next call.
  template <class Block>
  std::span<const Vertex> nodes(std::uint8_t vtk, const Block& block, std::size_t i) {
    const auto& corners = block.cells[i];
    std::array<Vertex, most_nodes> own;
    auto end = std::ranges::copy(corners, own.begin()).out;
    if (mesh_.second_order) std::ranges::copy(mesh_.second_order->of(vtk, i), end);
    const std::vector<std::size_t>& order = orders_[index(vtk)];
    for (std::size_t k = 0; k < order.size(); ++k) listed_[k] = own[order[k]];
    return std::span<const Vertex>(listed_).first(order.size());
  }

 private:
  static constexpr std::size_t most_nodes = 27;
  static constexpr std::array<std::uint8_t, 6> kinds{12, 13, 14, 10, vtk_code_of_triangle, vtk_code_of_quad};
  static std::size_t index(std::uint8_t vtk) {
    return static_cast<std::size_t>(std::ranges::find(kinds, vtk) - kinds.begin());
  }

  const MixedMesh& mesh_;
  std::array<std::vector<std::size_t>, kinds.size()> orders_;
  std::array<Vertex, most_nodes> listed_{};
};

}  // namespace hexpipe::formats
