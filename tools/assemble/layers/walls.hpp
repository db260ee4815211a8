#pragma once
// The walls of a mesh: facets on which layers stand, and the lines along which their corners go inwards.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::assemble::layers {

// The facets of a tag are walls: on all sides, or only on those of some regions.
struct WallGroup {
  std::int32_t tag;
  int layers;
  std::vector<std::int32_t> regions{};  // none: all
};

using LineIndex = Index<struct LineKind>;

// The vertices of a facet, ascending; a triangle ends with no_index.
using FacetVertices = std::array<Vertex, 4>;

// A facet of the boundary beyond the rim of a wall, over which its layers run out: see run_outs.hpp.
struct RunOut {
  FacetVertices facet;
  int layers;  // those of the wall
};

// A facet of a wall, or one over which layers run out, as one of its cells sees it. A triangle has no_index as its last
// corner.
struct WallSide {
  Quad corners;  // counter-clockwise as seen from outside the cell
  std::array<LineIndex, 4> lines;
  std::int32_t tag, region;
  int layers;
  bool is_run_out;

  int size() const { return corners[3] == no_index ? 3 : 4; }
};

// A tagged facet that is no wall, as one of its corners sees it. Lines stay on such facets.
struct Guide {
  Vec3 normal;   // unit, out of one of its cells
  Vec3 inwards;  // from the corner between its two edges
  std::int32_t tag;
  FacetVertices facet{};
  bool is_outer = true;  // on the boundary
};

// A line begins at a vertex of a wall and ends at its tip, a vertex of the inner mesh. A vertex has one line for each
// wedge of cells that the walls leave together there.
struct Line {
  Vertex foot = no_index;
  Vertex tip = no_index;  // no_index: this line has no length, and the wedge keeps the foot
  int layers = 0;
  bool is_on_wall = false;    // not only where layers run out
  std::vector<Vec3> normals;  // of the wall at the foot, unit, inwards
  std::vector<Guide> guides;
};

// Two lines that are next to each other on a wall.
struct LineEdge {
  std::array<LineIndex, 2> lines;  // ascending
  int sides = 0;                   // walls' sides that have the edge; one where the walls end
  std::int32_t tag = 0;            // of the facets that continue between the two lines
  bool is_tagged = false;
  bool is_outer = false;  // these facets are on the boundary
};

class Walls {
 public:
  // Finds all facets of the groups in the mesh. Each tag has one group; they and the run-outs are ascending.
  Walls(const MixedMesh& mesh, std::span<const WallGroup> groups, std::span<const RunOut> run_outs = {});

  std::span<const WallSide> sides() const { return sides_; }
  std::span<Line> lines() { return lines_; }
  std::span<const Line> lines() const { return lines_; }
  std::span<const LineEdge> edges() const { return edges_; }  // ascending
  const LineEdge& edge(LineIndex a, LineIndex b) const;

  // Appends a tip for each line that `grows`, in the place of its foot, and puts it into the cells and facets of its
  // wedge. Facets of the walls keep their feet.
  void split(MixedMesh& mesh, std::span<const std::uint8_t> grows);

 private:
  // A corner of a cell or of a tagged facet that is at a line.
  struct Use {
    std::int32_t block;  // as in all_cells() of walls.cpp
    std::int32_t cell;
    std::int32_t corner;
    LineIndex line;
  };
  std::vector<WallSide> sides_;
  std::vector<Line> lines_;
  std::vector<LineEdge> edges_;
  std::vector<Use> uses_;
};

}  // namespace hexpipe::assemble::layers
