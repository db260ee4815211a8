#include "common/curved/nodes.hpp"

#include <limits>

#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"

namespace hexpipe::curved {
namespace {

class NodeMaker {
 public:
  NodeMaker(MixedMesh& mesh, bool full) : mesh_(mesh) {
    nodes_.full = full;
    nodes_.first = static_cast<Vertex>(mesh.points.size());
  }

  void run() {
    for_each_element([&](std::uint8_t vtk, const auto& corners) {
      for (const auto& [a, b] : node_places_of(vtk).edges) node_of_edge(corners[a], corners[b]);
    });
    if (nodes_.full) {
      for_each_element([&](std::uint8_t vtk, const auto& corners) {
        for (const LocalQuad& quad : node_places_of(vtk).quads)
          node_of_quad({corners[quad[0]], corners[quad[1]], corners[quad[2]], corners[quad[3]]});
      });
    }
    for_each_element([&](std::uint8_t vtk, const auto& corners) { list_nodes(vtk, corners); });
    mesh_.second_order = std::move(nodes_);
  }

 private:
  template <class Visit>
  void for_each_element(Visit&& visit) {
    const auto each = [&](std::uint8_t vtk, const auto& block) {
      for (const auto& corners : block.cells) visit(vtk, corners);
    };
    each(static_cast<std::uint8_t>(CellKind::hex), mesh_.hexes);
    each(static_cast<std::uint8_t>(CellKind::prism), mesh_.prisms);
    each(static_cast<std::uint8_t>(CellKind::pyramid), mesh_.pyramids);
    each(static_cast<std::uint8_t>(CellKind::tet), mesh_.tets);
    each(vtk_code_of_triangle, mesh_.triangles);
    each(vtk_code_of_quad, mesh_.quads);
  }

  Vertex add(const Vec3& at) {
    if (mesh_.points.size() >= static_cast<std::size_t>(std::numeric_limits<Vertex>::max()))
      throw DataError::at("--order 2", "expected at most {} nodes, found more", std::numeric_limits<Vertex>::max());
    mesh_.points.push_back(at);
    return static_cast<Vertex>(mesh_.points.size() - 1);
  }

  Vertex node_of_edge(Vertex a, Vertex b) {
    const auto [place, is_new] = edges_.try_emplace(edge_key(a, b), 0);
    if (is_new) place.value() = add(0.5 * (mesh_.points[a] + mesh_.points[b]));
    return place->second;
  }

  Vertex node_of_quad(const Quad& quad) {
    const auto [place, is_new] = quads_.try_emplace(key_of(quad), 0);
    const auto& p = mesh_.points;
    if (is_new) place.value() = add(0.25 * (p[quad[0]] + p[quad[1]] + p[quad[2]] + p[quad[3]]));
    return place->second;
  }

  template <class Corners>
  void list_nodes(std::uint8_t vtk, const Corners& corners) {
    const NodePlaces places = node_places_of(vtk);
    std::vector<Vertex>& list = nodes_.of_kind(vtk);
    for (const auto& [a, b] : places.edges) list.push_back(edges_.at(edge_key(corners[a], corners[b])));
    if (!nodes_.full) return;
    for (const LocalQuad& quad : places.quads)
      list.push_back(quads_.at(key_of(Quad{corners[quad[0]], corners[quad[1]], corners[quad[2]], corners[quad[3]]})));
    if (!places.has_middle) return;
    Vec3 middle;
    for (const Vertex v : corners) middle += (1.0 / static_cast<double>(corners.size())) * mesh_.points[v];
    list.push_back(add(middle));
  }

  MixedMesh& mesh_;
  SecondOrder nodes_;
  KeyMap<2, Vertex> edges_;
  KeyMap<4, Vertex> quads_;
};

}  // namespace

void add_straight_nodes(MixedMesh& mesh, bool full) {
  NodeMaker(mesh, full).run();
}

Vec3 middle_of_quad(const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& edges) {
  const auto sum = [](const std::array<Vec3, 4>& at) { return (at[0] + at[2]) + (at[1] + at[3]); };
  return 0.5 * sum(edges) - 0.25 * sum(corners);
}

// Transfinite interpolation between the sides.
Vec3 middle_of_hex(std::span<const Vec3> corners, std::span<const Vec3> edges, std::span<const Vec3> quads) {
  Vec3 middle;
  for (const Vec3& at : quads) middle += 0.5 * at;
  for (const Vec3& at : edges) middle -= 0.25 * at;
  for (const Vec3& at : corners) middle += 0.125 * at;
  return middle;
}

std::size_t edge_between(std::span<const LocalEdge> edges, std::uint8_t a, std::uint8_t b) {
  std::size_t i = 0;
  while (!(edges[i][0] == a && edges[i][1] == b) && !(edges[i][0] == b && edges[i][1] == a)) ++i;
  return i;
}

}  // namespace hexpipe::curved
