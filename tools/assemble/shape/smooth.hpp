#pragma once
// Moves vertices so that the worst cells become better first, then the average, and hexes larger.

#include <span>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::shape {

struct SmoothCounts {
  int rounds = 0;  // done; fewer than asked for when nothing moved any more
  std::int64_t moves = 0;
};

// What lets vertices on curved parts of the boundary slide on the input's surface. `origin` as in Extract.
struct SlidingSurface {
  const InputSurface& surface;
  std::span<const Vec3> input_points;
  std::span<const Vertex> origin;
  // By vertex of the input: 1 for one that has to stay; empty where there is none.
  std::span<const std::uint8_t> stays = {};

  bool has_to_stay(Vertex v) const {
    const auto from = static_cast<std::size_t>(origin[v]);
    return from < stays.size() && stays[from] != 0;
  }
};

// What counts as poor: the least scaled Jacobian (of a tet times the square root of 2) that cells should have.
inline constexpr double poor_quality = 0.02;
inline constexpr double poor_hex = 0.1;

// Makes cells that are poor or inverted better, at most `rounds` times over their vertices, at the cost of those around
// them; cells that are valid stay so, and hexes of a scaled Jacobian of 0.3 at least do.
void untangle(MixedMesh& mesh, int rounds, const SlidingSurface* sliding = nullptr);

// At most `rounds` times over all vertices. No vertex leaves its plane or line (freedom.hpp), no move makes the worst
// cell around it worse than good enough (hexes 0.24, others 0.12), or worse at all where it is not, or presses a hex
// below a scaled Jacobian of 0.3; every cell stays valid everywhere. With `sliding`, vertices on curved surfaces and
// curves slide on them where the worst cell is poor, within a small part of an edge length of the input's surface.
SmoothCounts smooth(MixedMesh& mesh, int rounds, const SlidingSurface* sliding = nullptr);

}  // namespace hexpipe::assemble::shape
