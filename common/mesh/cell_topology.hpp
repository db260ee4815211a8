#pragma once
/* The one numbering of corners, edges and facets that everything in hexpipe uses. Hex, pyramid and tet are as in VTK,
   Gmsh and MEDIT; the prism is Gmsh's and MEDIT's (det(01, 02, 03) > 0); VTK's files list its triangles the
   other way round, see formats/meshes/vtk_grid.hpp.

          hex                      prism                   pyramid                  tet

         7--------6                 5                        4                       3
        /|       /|               / | \                    /|\ \                    /|\
       / |      / |              3-----4                  / | \  \                 / | \
      4--------5  |              |  |  |                 /  3--\---2              /  |  \
      |  3-----|--2              |  2  |                / /     \ /              0---|---2
      | /      | /               | / \ |               0---------1                \  |  /
      |/       |/                |/   \|                                            \|/
      0--------1                 0-----1                                             1

   Facets are listed with their corners counter-clockwise seen from outside, so their normals point out of a cell whose
   Jacobian is positive. */

#include <array>
#include <cstddef>
#include <cstdint>

namespace hexpipe {

// The values are VTK's cell codes, as candidates/kind.npy holds them. VTK calls a prism "wedge".
enum class CellKind : std::uint8_t { tet = 10, hex = 12, prism = 13, pyramid = 14 };

using LocalEdge = std::array<std::uint8_t, 2>;
using LocalTriangle = std::array<std::uint8_t, 3>;
using LocalQuad = std::array<std::uint8_t, 4>;
// A corner and the three corners that its edges lead to, in the order that gives a valid cell a positive determinant.
using LocalCorner = std::array<std::uint8_t, 4>;

struct TetTopology {
  static constexpr CellKind kind = CellKind::tet;
  static constexpr int corner_count = 4;
  static constexpr std::array<LocalEdge, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  // Facet i is opposite corner i.
  static constexpr std::array<LocalTriangle, 4> triangles{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  static constexpr std::array<LocalQuad, 0> quads{};
  static constexpr std::array<LocalCorner, 4> corners{{{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}}};
};

struct HexTopology {
  static constexpr CellKind kind = CellKind::hex;
  static constexpr int corner_count = 8;
  static constexpr std::array<LocalEdge, 12> edges{
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  static constexpr std::array<LocalTriangle, 0> triangles{};
  static constexpr std::array<LocalQuad, 6> quads{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  static constexpr std::array<LocalCorner, 8> corners{
      {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};
};

struct PrismTopology {
  static constexpr CellKind kind = CellKind::prism;
  static constexpr int corner_count = 6;
  static constexpr std::array<LocalEdge, 9> edges{
      {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
  static constexpr std::array<LocalTriangle, 2> triangles{{{0, 2, 1}, {3, 4, 5}}};
  static constexpr std::array<LocalQuad, 3> quads{{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
  static constexpr std::array<LocalCorner, 6> corners{
      {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
};

// Four edges meet at the apex, so it is no LocalCorner: only the corners of the base are listed.
struct PyramidTopology {
  static constexpr CellKind kind = CellKind::pyramid;
  static constexpr int corner_count = 5;
  static constexpr std::array<LocalEdge, 8> edges{{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
  static constexpr std::array<LocalTriangle, 4> triangles{{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  static constexpr std::array<LocalQuad, 1> quads{{{0, 3, 2, 1}}};
  static constexpr std::array<LocalCorner, 4> corners{{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
};

// Calls visit(Topology{}) with the topology of a kind, so that code for all kinds is written once.
template <class Visitor>
constexpr decltype(auto) with_topology(CellKind kind, Visitor&& visit) {
  switch (kind) {
    case CellKind::hex:
      return visit(HexTopology{});
    case CellKind::prism:
      return visit(PrismTopology{});
    case CellKind::pyramid:
      return visit(PyramidTopology{});
    case CellKind::tet:
      break;
  }
  return visit(TetTopology{});
}

constexpr int corner_count(CellKind kind) {
  return with_topology(kind, [](auto topology) { return decltype(topology)::corner_count; });
}

constexpr const char* name_of(CellKind kind) {
  switch (kind) {
    case CellKind::hex:
      return "hex";
    case CellKind::prism:
      return "prism";
    case CellKind::pyramid:
      return "pyramid";
    case CellKind::tet:
      break;
  }
  return "tet";
}

namespace topology_checks {

// The facets of a closed cell walk along every edge once in each direction, and every edge is in the edge list.
template <class Topology>
constexpr bool facets_close() {
  auto directed = [](int from, int to) {
    int count = 0;
    for (const auto& t : Topology::triangles)
      for (std::size_t i = 0; i < 3; ++i) count += t[i] == from && t[(i + 1) % 3] == to;
    for (const auto& q : Topology::quads)
      for (std::size_t i = 0; i < 4; ++i) count += q[i] == from && q[(i + 1) % 4] == to;
    return count;
  };
  std::size_t walked = 0;
  for (int a = 0; a < Topology::corner_count; ++a)
    for (int b = 0; b < Topology::corner_count; ++b) walked += static_cast<std::size_t>(directed(a, b));
  for (const auto& e : Topology::edges)
    if (directed(e[0], e[1]) != 1 || directed(e[1], e[0]) != 1) return false;
  return walked == 2 * Topology::edges.size();
}

// The three edges listed at each corner are edges of the cell.
template <class Topology>
constexpr bool corners_follow_edges() {
  for (const auto& c : Topology::corners)
    for (std::size_t i = 1; i < 4; ++i) {
      bool found = false;
      for (const auto& e : Topology::edges)
        found = found || (e[0] == c[0] && e[1] == c[i]) || (e[1] == c[0] && e[0] == c[i]);
      if (!found) return false;
    }
  return true;
}

static_assert(facets_close<TetTopology>() && corners_follow_edges<TetTopology>());
static_assert(facets_close<HexTopology>() && corners_follow_edges<HexTopology>());
static_assert(facets_close<PrismTopology>() && corners_follow_edges<PrismTopology>());
static_assert(facets_close<PyramidTopology>() && corners_follow_edges<PyramidTopology>());

}  // namespace topology_checks
}  // namespace hexpipe
