#pragma once
// Draws the inner mesh back from the walls, so that lines get their lengths.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/layers/columns.hpp"
#include "tools/assemble/layers/guide_surface.hpp"
#include "tools/assemble/layers/line_plan.hpp"
#include "tools/assemble/layers/walls.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble::layers {

// The walls whose tips move, and what limits them.
struct DrawBackInput {
  const Walls& walls;
  const LinePlan& plan;
  const GuideSurface& guides;
  const LinePoints& places;
  const shape::SlidingSurface& sliding;  // `stays` holds all feet
  double least_quality;                  // of the cells of layers, as a scaled Jacobian
};

struct DrawBackResult {
  // By line: the share of its way that the tip has gone.
  std::vector<double> shares;
  // Lines whose tips cannot leave their feet. If there are any, the mesh is of no use: it has to be split anew without
  // these lines.
  std::vector<LineIndex> stuck;
};

// Moves tips towards their goals, and vertices inside out of their way. All cells stay valid, and so are all cells of
// layers afterwards. Hexes stay above least_hex_quality and others above good_enough, or lose a twentieth of their
// quality in each pass. Where lines would come to less than a quarter of their way, these limits fall to 0.6 of what the
// cell had, but not below 0.2 and 0.06; in the first pass, where lines would come to less than a twentieth, to the lower
// of 0.01 and 0.6 of what the cell had.
DrawBackResult draw_back(MixedMesh& mesh, const DrawBackInput& input);

}  // namespace hexpipe::assemble::layers
