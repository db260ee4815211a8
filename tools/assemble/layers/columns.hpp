#pragma once
// The cells of the layers: where they stand and which points they have.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/layers/guide_surface.hpp"
#include "tools/assemble/layers/line_plan.hpp"
#include "tools/assemble/layers/walls.hpp"

namespace hexpipe::assemble::layers {

// A point of a line: level 0 is its foot, and level `layers` its tip. All levels of a line without length are its foot.
struct LinePoint {
  LineIndex line;
  int level;
};

// A cell of a layer, or a facet of one.
struct LayerCell {
  CellKind kind;
  std::array<LinePoint, 8> corners;
};
struct LayerFacet {
  int size;                          // 3 or 4
  std::array<LinePoint, 4> corners;  // counter-clockwise as seen from outside the cell
  std::int32_t tag;
};

// The cell between `level` and the next one over the side; nothing if no line of it has a length. A quad over which one
// or three lines have a length has no such cell: close_over_quads() leaves none.
std::optional<LayerCell> layer_cell(const Walls& walls, const WallSide& side, int level);
// The facet of this cell at the edge behind corner `corner` of the side.
std::optional<LayerFacet> layer_facet(const Walls& walls, const WallSide& side, int corner, int level);

// Where points of lines are, with the tips where the mesh has them.
class LinePoints {
 public:
  // All arguments outlive this. `growth`: each layer is higher than the one before by this factor.
  LinePoints(const Walls& walls, const LinePlan& plan, const GuideSurface& guides, double growth);

  Vec3 at(std::span<const Vec3> points, const LinePoint& point) const;
  // That of the lowest of `layers` layers in the length of a line.
  double lowest_share(int layers) const;
  // The corners of a cell; as many as it has.
  std::array<Vec3, 8> corners(std::span<const Vec3> points, const LayerCell& cell) const;

 private:
  const Walls& walls_;
  const LinePlan& plan_;
  const GuideSurface& guides_;
  // By number of layers and level: share_of_height(). Asked for far too often to be computed each time.
  std::vector<std::vector<double>> shares_;
};

// The share of the height of `layers` layers that the first `level` have.
double share_of_height(int level, int layers, double growth);

// Appends the layers to the mesh between the walls and the tips: cells, points, and facets beside the ends of walls.
void append_columns(MixedMesh& mesh, std::vector<Vertex>& origin, const Walls& walls, const LinePoints& places);

}  // namespace hexpipe::assemble::layers
