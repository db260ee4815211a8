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

// What moves, and what it may not leave.
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
// layers afterwards; hexes stay above least_hex_quality and others above good enough, or as they are.
DrawBackResult draw_back(MixedMesh& mesh, const DrawBackInput& input);

}  // namespace hexpipe::assemble::layers
