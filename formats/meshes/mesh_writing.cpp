#include "formats/meshes/mesh_writing.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "common/curved/nodes.hpp"
#include "common/mesh/box_tree.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"
#include "formats/meshes/facet_table.hpp"
#include "formats/meshes/mesh_blocks.hpp"

namespace hexpipe::formats {
namespace {

template <class Topology, class Block>
void add_quads(const Block& block, KeySet<4>& quads) {
  for (const auto& cell : block.cells)
    for (const LocalQuad& corners : Topology::quads) quads.insert(key_of(pick(cell, corners)));
}

// The corners of a quad in their order, beginning with the lowest vertex.
template <class Corners>
std::array<std::size_t, 4> from_lowest(const Corners& corners) {
  const auto first = static_cast<std::size_t>(std::min_element(corners.begin(), corners.begin() + 4) - corners.begin());
  return {first, (first + 1) % 4, (first + 2) % 4, (first + 3) % 4};
}

// Cuts pyramids, and the facets that they alone have.
class PyramidSplitter {
 public:
  PyramidSplitter(const MixedMesh& mesh, std::vector<TiedNode>* tied) : mesh_(mesh), result_(mesh), tied_(tied) {
    for (const auto& cell : mesh.pyramids.cells) ++bases_[key_of(base_of(cell))];
    add_quads<HexTopology>(mesh.hexes, others_);
    add_quads<PrismTopology>(mesh.prisms, others_);
  }

  MixedMesh run() {
    result_.pyramids = {};
    if (order()) order()->pyramids.clear();
    // The new cells have no quality yet.
    for_each_block(result_, [](const ElementNames&, auto& block) { block.quality.clear(); });
    for (std::size_t i = 0; i < mesh_.pyramids.size(); ++i) split_cell(i);
    split_facets();
    return std::move(result_);
  }

 private:
  static Quad base_of(const std::array<Vertex, 5>& cell) { return {cell[0], cell[1], cell[2], cell[3]}; }
  SecondOrder* order() { return result_.second_order ? &*result_.second_order : nullptr; }

  void split_cell(std::size_t i) {
    const auto& cell = mesh_.pyramids.cells[i];
    const auto [a, b, c, d] = from_lowest(cell);
    const std::size_t apex = 4;
    for (const auto& tet : {std::array{a, b, c, apex}, std::array{a, c, d, apex}}) {
      result_.tets.cells.push_back({cell[tet[0]], cell[tet[1]], cell[tet[2]], cell[tet[3]]});
      result_.tets.tags.push_back(mesh_.pyramids.tags[i]);
    }
    if (!order()) return;
    const std::span<const Vertex> nodes = mesh_.second_order->of(pyramid_names.vtk, i);
    const auto edge = [&](std::size_t p, std::size_t q) {
      return nodes[curved::edge_between(PyramidTopology::edges, static_cast<std::uint8_t>(p), static_cast<std::uint8_t>(q))];
    };
    const Vertex diagonal = diagonal_node(base_of(cell), {edge(0, 1), edge(1, 2), edge(2, 3), edge(3, 0)}, nodes);
    for (const Vertex v : {edge(a, b), edge(b, c), diagonal, edge(a, apex), edge(b, apex), edge(c, apex),  //
                           diagonal, edge(c, d), edge(d, a), edge(a, apex), edge(c, apex), edge(d, apex)})
      order()->tets.push_back(v);
  }

  // The node in the middle of the base, which full elements have.
  Vertex diagonal_node(const Quad& base, const std::array<Vertex, 4>& edges, std::span<const Vertex> nodes) {
    const auto [place, is_new] = diagonals_.try_emplace(key_of(base), no_node);
    if (!is_new) return place->second;
    if (order()->full) return place.value() = nodes.back();
    std::array<Vec3, 4> corners, middles;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = mesh_.points[base[k]], middles[k] = mesh_.points[edges[k]];
    result_.points.push_back(curved::middle_of_quad(corners, middles));
    place.value() = static_cast<Vertex>(result_.points.size() - 1);
    if (tied_ != nullptr && others_.contains(key_of(base))) tied_->push_back({place->second, base, edges});
    return place->second;
  }

  void split_facets() {
    result_.quads = {};
    if (order()) order()->quads.clear();
    for (std::size_t i = 0; i < mesh_.quads.size(); ++i) {
      const auto& quad = mesh_.quads.cells[i];
      if (bases_.contains(key_of(quad)) && !others_.contains(key_of(quad))) {
        split_facet(i);
        continue;
      }
      result_.quads.cells.push_back(quad);
      result_.quads.tags.push_back(mesh_.quads.tags[i]);
      if (!order()) continue;
      for (const Vertex v : mesh_.second_order->of(vtk_code_of_quad, i)) order()->quads.push_back(v);
    }
  }

  void split_facet(std::size_t i) {
    const auto& quad = mesh_.quads.cells[i];
    const auto [a, b, c, d] = from_lowest(quad);
    for (const auto& triangle : {std::array{a, b, c}, std::array{a, c, d}}) {
      result_.triangles.cells.push_back({quad[triangle[0]], quad[triangle[1]], quad[triangle[2]]});
      result_.triangles.tags.push_back(mesh_.quads.tags[i]);
    }
    if (!order()) return;
    const std::span<const Vertex> edges = mesh_.second_order->of(vtk_code_of_quad, i);
    const Vertex diagonal = diagonals_.at(key_of(quad));
    for (const Vertex v : {edges[a], edges[b], diagonal, diagonal, edges[c], edges[d]}) order()->triangles.push_back(v);
  }

  static constexpr Vertex no_node = -1;

  const MixedMesh& mesh_;
  MixedMesh result_;
  std::vector<TiedNode>* tied_;
  KeyMap<4, int> bases_;
  KeySet<4> others_;
  KeyMap<4, Vertex> diagonals_;
};

}  // namespace

MixedMesh with_split_pyramids(const MixedMesh& mesh, std::vector<TiedNode>* tied) {
  return PyramidSplitter(mesh, tied).run();
}

void check_numbers(std::size_t count, std::size_t most, std::string_view name) {
  if (count > most)
    throw DataError::at(name, "cannot write {} points or elements: the format numbers at most {}", count, most);
}

double negligible_length(const MixedMesh& mesh) {
  if (mesh.points.empty()) return 0;
  return 1e-15 * Box::around(mesh.points).diagonal();
}

}  // namespace hexpipe::formats
