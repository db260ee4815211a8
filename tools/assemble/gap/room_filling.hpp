#pragma once
// How a room of any size can be filled: with cells on its skin, and around vertices inside.

#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/solids.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::gap {

struct RoomFilling {
  std::vector<Solid> cells;
  std::vector<std::vector<Facet>> stars;  // skins, each of whose facets is joined to one vertex inside
  std::size_t count = 0;                  // cells that are no hexes
};

// The filling with the fewest cells that are no hexes, if they are fewer than `most`: hexes and prisms most of whose
// facets are there, taken out of the room one after the other, and what is left as single cells or as stars. A vertex
// inside of a star has to see all of it, but other cells may still be as inverted as least_before_raising.
std::optional<RoomFilling> fewest_cells(const GapMesh& gap, std::span<const Facet> skin, std::size_t most);

// Where a vertex sees all facets best, and how well.
shape::Placement middle_of_star(std::span<const Vec3> points, std::span<const Facet> skin);

}  // namespace hexpipe::assemble::gap
