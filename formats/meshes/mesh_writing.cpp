#include "formats/meshes/mesh_writing.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

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
    for (const auto& cell : mesh.pyramids.cells) bases_.insert(key_of(base_of(cell)));
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
    if (order()) return split_in_four(cell, mesh_.second_order->of(pyramid_names.vtk, i), mesh_.pyramids.tags[i]);
    const auto [a, b, c, d] = from_lowest(cell);
    const std::size_t apex = 4;
    for (const auto& tet : {std::array{a, b, c, apex}, std::array{a, c, d, apex}})
      add_tet({cell[tet[0]], cell[tet[1]], cell[tet[2]], cell[tet[3]]}, mesh_.pyramids.tags[i]);
  }

  void add_tet(const std::array<Vertex, 4>& corners, std::int32_t tag) {
    result_.tets.cells.push_back(corners);
    result_.tets.tags.push_back(tag);
  }

  // The nodes of the pyramid: four of the base's edges, then four of the edges to the apex.
  void split_in_four(const std::array<Vertex, 5>& cell, std::span<const Vertex> nodes, std::int32_t tag) {
    const Base& base = nodes_of_base(base_of(cell), nodes);
    const Vertex axis = add_point(0.5 * (result_.points[base.middle] + mesh_.points[cell[4]]));
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      add_tet({cell[k], cell[next], base.middle, cell[4]}, tag);
      for (const Vertex v :
           {nodes[k], base.towards(cell[next]), base.towards(cell[k]), nodes[4 + k], nodes[4 + next], axis})
        order()->tets.push_back(v);
    }
  }

  // The nodes that tets have on the base of a pyramid: its middle, and the middles of the lines to its corners.
  struct Base {
    Vertex middle;
    Quad corners, between;

    Vertex towards(Vertex corner) const {
      return between[static_cast<std::size_t>(std::ranges::find(corners, corner) - corners.begin())];
    }
  };

  const Base& nodes_of_base(const Quad& corners, std::span<const Vertex> nodes) {
    const auto [place, is_new] = base_nodes_.try_emplace(key_of(corners));
    if (!is_new) return place->second;
    Base& base = place.value();
    base.corners = corners;
    const bool is_tied = tied_ != nullptr && others_.contains(key_of(corners));
    const auto add = [&](std::vector<TiedNode::Term> terms) {
      Vec3 at;
      for (const auto& [node, factor] : terms) at += factor * mesh_.points[node];
      const Vertex v = add_point(at);
      if (is_tied) tied_->push_back({v, std::move(terms)});
      return v;
    };
    // Shape functions of the quad of eight or nine nodes, at its middle and at half of the way to a corner.
    std::vector<TiedNode::Term> middle;
    for (std::size_t k = 0; k < 4; ++k) middle.push_back({nodes[k], 0.5});
    for (std::size_t k = 0; k < 4; ++k) middle.push_back({corners[k], -0.25});
    base.middle = order()->full ? nodes[8] : add(std::move(middle));
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corner = [&](std::size_t i) { return corners[(k + i) % 4]; };
      const auto edge = [&](std::size_t i) { return nodes[(k + i) % 4]; };
      base.between[k] = order()->full ? add({{corner(0), 9.0 / 64},
                                             {corner(1), -3.0 / 64},
                                             {corner(2), 1.0 / 64},
                                             {corner(3), -3.0 / 64},
                                             {edge(0), 18.0 / 64},
                                             {edge(1), -6.0 / 64},
                                             {edge(2), -6.0 / 64},
                                             {edge(3), 18.0 / 64},
                                             {nodes[8], 36.0 / 64}})
                                      : add({{corner(1), -0.1875},
                                             {corner(2), -0.125},
                                             {corner(3), -0.1875},
                                             {edge(0), 0.5625},
                                             {edge(1), 0.1875},
                                             {edge(2), 0.1875},
                                             {edge(3), 0.5625}});
    }
    return base;
  }

  Vertex add_point(const Vec3& at) {
    result_.points.push_back(at);
    return static_cast<Vertex>(result_.points.size() - 1);
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
    const auto add = [&](const Triangle& triangle) {
      result_.triangles.cells.push_back(triangle);
      result_.triangles.tags.push_back(mesh_.quads.tags[i]);
    };
    if (!order()) {
      const auto [a, b, c, d] = from_lowest(quad);
      add({quad[a], quad[b], quad[c]});
      add({quad[a], quad[c], quad[d]});
      return;
    }
    const std::span<const Vertex> edges = mesh_.second_order->of(vtk_code_of_quad, i);
    const Base& base = base_nodes_.at(key_of(quad));
    for (std::size_t k = 0; k < 4; ++k) {
      const Vertex from = quad[k], to = quad[(k + 1) % 4];
      add({from, to, base.middle});
      for (const Vertex v : {edges[k], base.towards(to), base.towards(from)}) order()->triangles.push_back(v);
    }
  }

  const MixedMesh& mesh_;
  MixedMesh result_;
  std::vector<TiedNode>* tied_;
  KeySet<4> bases_, others_;
  KeyMap<4, Base> base_nodes_;
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
