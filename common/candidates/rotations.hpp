#pragma once
// The rotations that map a cell onto itself: all labellings of the same cell. They are derived from its topology table.

#include <array>
#include <cstdint>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

// rotation[c] is the corner that takes the place of corner c.
template <class Topology>
using Rotation = std::array<int, Topology::corner_count>;

template <class Topology, std::size_t Most>
struct RotationGroup {
  std::array<Rotation<Topology>, Most> rotations{};
  std::size_t count = 0;

  constexpr const Rotation<Topology>* begin() const { return rotations.data(); }
  constexpr const Rotation<Topology>* end() const { return rotations.data() + count; }
};

namespace rotation_details {

// Lays facet `from` onto facet `to`, turned so that its corner 0 comes to `shift`, and fills in the corners that `map`
// leaves open (no_index). False if this contradicts the map.
template <std::size_t Size, class Map>
constexpr bool lay_on(const std::array<std::uint8_t, Size>& from, const std::array<std::uint8_t, Size>& to,
                      std::size_t shift, Map& map) {
  Map filled = map;
  std::size_t known = 0;
  for (std::size_t i = 0; i < Size; ++i) {
    const int image = to[(i + shift) % Size];
    if (map[from[i]] == image)
      ++known;
    else if (map[from[i]] == no_index)
      filled[from[i]] = image;
    else
      return false;
  }
  if (known + 1 < Size) return false;
  map = filled;
  return true;
}

// Lays each facet onto some facet in the same sense of rotation.
template <class Facets, class Map>
constexpr bool lay_all(const Facets& facets, Map& map) {
  bool all = true;
  for (const auto& from : facets) {
    bool laid = false;
    for (const auto& to : facets)
      for (std::size_t shift = 0; shift < from.size() && !laid; ++shift) laid = lay_on(from, to, shift, map);
    all = all && laid;
  }
  return all;
}

}  // namespace rotation_details

// A rotation is determined by the images of corner 0 and of its three edges; the facets then extend it over the cell.
template <class Topology>
constexpr auto rotations_of() {
  RotationGroup<Topology, 3 * Topology::corners.size()> group;
  const LocalCorner& first = Topology::corners[0];
  for (const LocalCorner& corner : Topology::corners)
    for (std::size_t shift = 0; shift < 3; ++shift) {
      Rotation<Topology> map{};
      map.fill(no_index);
      map[first[0]] = corner[0];
      for (std::size_t i = 0; i < 3; ++i) map[first[1 + i]] = corner[1 + (i + shift) % 3];
      // The first round may meet a quad before its corners are known; the second round completes the map.
      rotation_details::lay_all(Topology::quads, map);
      if (rotation_details::lay_all(Topology::quads, map) && rotation_details::lay_all(Topology::triangles, map))
        group.rotations[group.count++] = map;
    }
  return group;
}

static_assert(rotations_of<HexTopology>().count == 24);
static_assert(rotations_of<PrismTopology>().count == 6);
static_assert(rotations_of<PyramidTopology>().count == 4);

}  // namespace hexpipe::candidates
