#pragma once

#include <vector>

#include "tools/assemble/layers/wall_choice.hpp"

namespace hexpipe::assemble {

// The command line of assemble.
struct AssembleOptions {
  // pyramids: every quad of a cell has another cell on its other side.
  enum class Conformity { pyramids, none };
  Conformity conformity = Conformity::pyramids;
  // quads: chosen hexes are exchanged so that fewer quads are open (choice/exchange.hpp). Only if the result conforms.
  enum class Exchange { quads, none };
  Exchange exchange = Exchange::quads;
  // prisms: tets between the chosen cells become prisms (choice/prism_filling.hpp). Only if the result conforms.
  enum class Fill { prisms, none };
  Fill fill = Fill::prisms;
  // vertices: vertices between the cells merge, gaps close, and rooms there are filled anew (gap/fewer_cells.hpp).
  // Only if the result conforms and is smoothed.
  enum class Merge { vertices, none };
  Merge merge = Merge::vertices;
  // finite_volumes: after the poor cells, what OpenFOAM's checkMesh counts as wrong is mended too, for a few more cells
  // (gap/mend_refused.cpp). Only with Merge::vertices.
  enum class Mend { quality, finite_volumes };
  Mend mend = Mend::quality;
  int smooth = 5;  // rounds over all vertices
};

// Layers at walls. Only if the result conforms.
struct LayerOptions {
  std::vector<layers::AskedWall> walls{};
  double first_height = 0, growth = 1.2;
  bool pillow = false;           // one layer on all of the boundary, behind those of the walls
  layers::TagNames tag_names{};  // for the walls
};

}  // namespace hexpipe::assemble
