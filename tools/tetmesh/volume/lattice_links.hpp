#pragma once
// How the nodes of a mesh see their neighbours along a frame field. ../surface/surface_links.hpp does the same for the
// triangles of a surface and a cross field.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/tetmesh/fields/periodic_link.hpp"
#include "tools/tetmesh/volume/field_nodes.hpp"

namespace hexpipe::tetmesh::volume {

using LatticeLink = fields::PeriodicLink<3>;

// Three links that close a triangle of nodes, of which the first is the lowest and the last the highest.
struct LinkTriangle {
  std::int64_t to_second, to_third, onward;  // from the first node, and from the second to the third
};

class LatticeLinks {
 public:
  LatticeLinks(const FieldNodes& nodes, const std::vector<fields::Frame>& frames);

  const FieldNodes& nodes() const { return nodes_; }
  std::span<const LatticeLink> of(std::size_t node) const {
    return std::span(links_).subspan(nodes_.offsets[node], nodes_.offsets[node + 1] - nodes_.offsets[node]);
  }
  LatticeLink& operator[](std::int64_t link) { return links_[link]; }
  const LatticeLink& operator[](std::int64_t link) const { return links_[link]; }
  std::size_t size() const { return links_.size(); }
  // Node after node.
  std::span<const LatticeLink> all() const { return links_; }

  // The number of the link, or no_index.
  std::int64_t between(std::int32_t from, std::int32_t to) const;
  // Calls body(node, number of its link) for the links that lead to a later node, of all nodes or of one.
  template <class Body>
  void for_each_pair(Body&& body) const {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(nodes_.size()); ++i) for_each_pair_of(i, body);
  }
  template <class Body>
  void for_each_pair_of(std::int32_t i, Body&& body) const {
    for (std::int64_t l = nodes_.offsets[i]; l < nodes_.offsets[i + 1]; ++l)
      if (nodes_.links[l].node > i) body(i, l);
  }
  // Calls body(triangle) for the triangles of which the node is the lowest.
  template <class Body>
  void for_each_triangle_of(std::int32_t i, Body&& body) const {
    for_each_pair_of(i, [&](std::int32_t, std::int64_t ij) {
      const std::int32_t j = nodes_.links[ij].node;
      std::int64_t jl = nodes_.offsets[j];
      // Links ascend by their nodes.
      for (std::int64_t il = ij + 1; il < nodes_.offsets[i + 1]; ++il) {
        while (jl < nodes_.offsets[j + 1] && nodes_.links[jl].node < nodes_.links[il].node) ++jl;
        if (jl == nodes_.offsets[j + 1]) return;
        if (nodes_.links[jl].node == nodes_.links[il].node)
          body(LinkTriangle{.to_second = ij, .to_third = il, .onward = jl});
      }
    });
  }
  // Whether the first node's axis is the same one again after a walk around the triangle, and runs the same way. Where
  // a singularity of the frames pierces the triangle, the axis along the singularity still is.
  bool comes_back(const LinkTriangle& triangle, std::size_t axis) const;
  // Whether all axes come back, so that no singularity pierces the triangle.
  bool is_regular(const LinkTriangle& triangle) const;

 private:
  LatticeLink make(const std::vector<fields::Frame>& frames, std::size_t i, const FieldLink& link) const;

  const FieldNodes& nodes_;
  std::vector<LatticeLink> links_;
};

}  // namespace hexpipe::tetmesh::volume
