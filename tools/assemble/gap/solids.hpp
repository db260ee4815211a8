#pragma once
// Cells that are told from the facets around them.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {

// A cell of any kind by its corners.
struct Solid {
  CellKind kind = CellKind::tet;
  std::array<Vertex, 8> corners{};

  std::span<const Vertex> vertices() const {
    return std::span(corners).first(static_cast<std::size_t>(corner_count(kind)));
  }
};

// The cell whose facets these are; nothing if there is none.
std::optional<Solid> solid_of(std::span<const Facet> skin);

// The hex on a quad of the skin, or the prism on a triangle, whose other corners are known because quads of the skin
// stand on all edges of `base`, or on all but one.
std::optional<Solid> solid_on(std::span<const Facet> skin, const Facet& base);

// The skin of what is left of a room when the cell is taken out. Nothing if the cell lies on the outer side of one of
// the facets.
std::optional<std::vector<Facet>> skin_without(std::span<const Facet> skin, const Solid& solid);

// The parts of a skin that no edge joins.
std::vector<std::vector<Facet>> bodies_of(std::span<const Facet> skin);

}  // namespace hexpipe::assemble::gap
