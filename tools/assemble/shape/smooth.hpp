#pragma once
// Moves vertices: the worst cells become better first, then the average cell, and hexes larger.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/shape/input_surface.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::shape {

// By vertex: which way it may move so that boundary, interfaces and the borders of their tags stay as they are. A
// vertex inside may go anywhere; on tagged facets of one plane and one tag, in that plane; on tagged facets of two
// planes with one tag each, along their common line; others nowhere.
std::vector<Freedom> vertex_freedoms(const MixedMesh& mesh);

struct SmoothCounts {
  int rounds = 0;  // fewer than asked for if nothing moved any more
  std::int64_t moves = 0;
};

// Lets vertices slide on the input's surface where the boundary is curved. `origin` as in Extract.
struct SlidingSurface {
  const InputSurface& surface;
  std::span<const Vec3> input_points;
  std::span<const Vertex> origin;
  // By vertex of the input: 1 if it has to stay; empty if none has to.
  std::span<const std::uint8_t> stays = {};

  bool has_to_stay(Vertex v) const {
    const auto from = static_cast<std::size_t>(origin[v]);
    return from < stays.size() && stays[from] != 0;
  }
};

// The least scaled Jacobian (of a tet times the square root of 2) that cells should have: below it they are poor.
inline constexpr double poor_quality = 0.02;
inline constexpr double poor_hex = 0.1;

// Makes poor and inverted cells better at the cost of the cells around them, in at most `rounds` rounds over their
// vertices. Valid cells stay valid; hexes stay above least_hex_quality, and prisms above
// least_prism_quality, or as they are.
void untangle(MixedMesh& mesh, int rounds, const SlidingSurface* sliding = nullptr);

// By vertex of the input, where smoothing found nothing more to do: what was around it then. A vertex around which
// nothing has changed since need not be looked at again.
using Settled = std::vector<std::uint64_t>;

// Smooths in at most `rounds` rounds over all vertices. No vertex leaves its plane or line (vertex_freedoms). No move
// takes the worst cell around it below good enough (hexes twice good_enough, prisms 0.3), or makes it worse if it is
// below, or presses a hex below least_hex_quality or a prism below least_prism_quality. Every cell stays valid
// everywhere. With `sliding`, vertices slide on curved surfaces and curves where the worst cell is poor, within a small
// fraction of an edge length of the input's surface. `settled`, which needs `sliding`, is read and written.
SmoothCounts smooth(MixedMesh& mesh, int rounds, const SlidingSurface* sliding = nullptr, Settled* settled = nullptr);

// As smooth(), but for vertices among hexes alone, also where smooth() passes over them because all are above 0.9. The
// mean hex gets better, and no other cell changes. For the end, because there are many such vertices.
SmoothCounts polish(MixedMesh& mesh, int rounds, const SlidingSurface* sliding = nullptr);

// Raises the worst pyramid, then the worst tet, and the next where that came about, until one is good enough or does
// not rise. Vertices of all cells around it move together, on the surface as in smooth(), so that its neighbours become
// better than they have to be and can yield. No other cell falls below good enough that was not below before, and none
// that was becomes worse, nor do those that are no hexes on average; hexes stay above least_hex_quality and
// prisms above least_prism_quality, or as they are. Returns the number of cells that rose.
std::int64_t raise_worst_cells(MixedMesh& mesh, const SlidingSurface& sliding);

}  // namespace hexpipe::assemble::shape
