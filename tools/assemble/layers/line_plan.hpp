#pragma once
// Where lines should end: directions that all facets of the wall see, and heights for which there is room.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/layers/guide_surface.hpp"
#include "tools/assemble/layers/walls.hpp"

namespace hexpipe::assemble::layers {

struct LinePlan {
  std::vector<std::uint8_t> grows;     // by line: whether it can leave its foot at all
  std::vector<Vec3> reach;             // from foot to tip
  std::vector<double> room;            // the share of the asked height for which there is room
  std::vector<GuideFreedom> freedoms;  // from the guides
};

// The direction with the greatest least angle to all facets of the wall, and the sine of that angle; 0 where there is
// none.
struct Sight {
  Vec3 direction{};
  double sine = 0;
};
Sight sight_of(std::span<const Vec3> normals, const GuideFreedom& freedom);

// The sine of the least angle between a line and the facets at its foot. A line that sees less does not grow.
inline constexpr double least_sight = 0.08;
// Lines between two walls are longer than the height, by at most 1/0.4: where they see less, heights shrink.
inline constexpr double full_sight = 0.4;

// By line: whether it sees its wall, so that it could grow. `bare`: by vertex, 1 where lines have no length.
std::vector<std::uint8_t> lines_that_see(const Walls& walls, std::span<const std::uint8_t> bare);

// `heights`: by line, at right angles to the wall.
LinePlan plan_lines(const MixedMesh& mesh, const Walls& walls, std::span<const double> heights,
                    std::span<const std::uint8_t> bare);

// Takes away more lines until a quad has all four, the two of one edge, or none: other cells there would be no hexes
// or prisms.
void close_over_quads(const Walls& walls, std::span<const double> worth, std::vector<std::uint8_t>& grows);

}  // namespace hexpipe::assemble::layers
