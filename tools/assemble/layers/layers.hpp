#pragma once
// Layers of hexes and prisms on walls.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/layers/walls.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::layers {

struct LayerRules {
  std::vector<WallGroup> walls;  // by tag, ascending
  // The height of the first layer at the wall; each further one is higher by the factor `growth`. Nothing: all layers
  // of a line together are half as high as the edges of the wall at its foot are long.
  std::optional<double> first_height{};
  double growth = 1;
};

// A fraction of the diagonal of the mesh. Layers that are lower are nothing beside the coordinates' rounding.
inline constexpr double least_height = 1e-9;

// Counts of layers, for --stats and messages.
struct LayerCounts {
  std::int64_t facets = 0;      // of walls, counted from each side that has layers
  double area = 0;              // theirs
  double area_with_layers = 0;  // of those with all layers from all their corners
  double area_with_all = 0;     // of those that have 0.95 of the height that was asked for, or more, at all corners
  double area_with_some = 0;    // of those that have layers at some corners
  double least_share = 1;       // of the height that was asked for, where there are layers
  // Where the layers' cells begin among the mesh's hexes, prisms, pyramids and tets, once they are appended.
  std::array<std::size_t, 4> first_cells{};
  std::int64_t cells = 0;
  double least_quality = 1, mean_quality = 0;  // scaled Jacobians of the layers' cells
  std::int64_t bare = 0;                       // facets without layers
};

// Appends layers to the mesh: cells, points, and facets where walls end. `origin` as in Extract; a point of a line has
// its foot's. All other arguments outlive the call.
// The cells are the last ones of the mesh.
LayerCounts add_layers(MixedMesh& mesh, std::vector<Vertex>& origin, const TetMesh& input,
                       const shape::InputSurface& surface, const LayerRules& rules);

// Judges the layers' cells in the mesh: anew, if vertices have moved since add_layers() and no cells have come.
void judge_cells(const MixedMesh& mesh, LayerCounts& counts);

}  // namespace hexpipe::assemble::layers
