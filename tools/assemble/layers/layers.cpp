#include "tools/assemble/layers/layers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "common/run/progress.hpp"
#include "tools/assemble/layers/columns.hpp"
#include "tools/assemble/layers/draw_back.hpp"
#include "tools/assemble/layers/guide_surface.hpp"
#include "tools/assemble/layers/line_plan.hpp"
#include "tools/assemble/layers/open_quads.hpp"
#include "tools/assemble/layers/run_outs.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble::layers {
namespace {

// Splitting anew without lines that are stuck, then without those beside them, too; the last time without any line.
constexpr int most_attempts = 16, attempts_without_neighbours = 6;
// Quads that are cut let lines see other normals, so that others may have to be cut.
constexpr int most_openings = 3;
// The height of a line's layers, in edges of the wall, where no height is given.
constexpr double usual_share_of_edges = 0.5;
// Cells of layers are no worse than this.
constexpr double least_layer_quality = 0.02;
constexpr int untangling_rounds_behind = 10, rounds_behind_layers = 2;

std::vector<double> heights_of(const MixedMesh& mesh, const Walls& walls, const LayerRules& rules) {
  std::vector<double> heights, edges(walls.lines().size(), 0.0), counts(walls.lines().size(), 0.0);
  for (const LineEdge& edge : walls.edges())
    for (const LineIndex line : edge.lines) {
      edges[line] +=
          norm(mesh.points[walls.lines()[edge.lines[0]].foot] - mesh.points[walls.lines()[edge.lines[1]].foot]);
      ++counts[line];
    }
  for (std::size_t i = 0; i < walls.lines().size(); ++i) {
    const int layers = walls.lines()[i].layers;
    heights.push_back(rules.first_height ? *rules.first_height / share_of_height(1, layers, rules.growth)
                                         : usual_share_of_edges * edges[i] / counts[i]);
  }
  return heights;
}

std::vector<std::int32_t> guide_tags(const Walls& walls) {
  std::vector<std::int32_t> tags;
  for (const Line& line : walls.lines())
    for (const Guide& guide : line.guides) tags.push_back(guide.tag);
  sort_unique(tags);
  return tags;
}

double area_of(const MixedMesh& mesh, const WallSide& side) {
  const auto at = [&](int i) { return mesh.points[side.corners[i]]; };
  double area = norm(cross(at(1) - at(0), at(2) - at(0)));
  if (side.size() == 4) area += norm(cross(at(2) - at(0), at(3) - at(0)));
  return area / 2;
}

// One attempt's mesh and lines.
struct Layered {
  MixedMesh mesh;
  std::vector<Vertex> origin;
  Walls walls;
  LinePlan plan;
  DrawBackResult drawn;
};

// Points inside that have a vertex of the input as their origin, as tips have their feet's, get numbers of their own
// from `first` on: nothing holds them where that vertex is held.
void number_inner_points(const MixedMesh& mesh, Vertex first, std::vector<Vertex>& origin) {
  std::vector<std::uint8_t> is_on_facet(mesh.points.size(), 0), is_taken(static_cast<std::size_t>(first), 0);
  const auto mark = [&](const auto& block) {
    for (const auto& facet : block.cells)
      for (const Vertex v : facet) is_on_facet[v] = 1;
  };
  mark(mesh.triangles);
  mark(mesh.quads);
  for (std::size_t v = 0; v < origin.size(); ++v)
    if (origin[v] < first && is_on_facet[v] != 0) is_taken[origin[v]] = 1;
  Vertex next = std::max(first, *std::ranges::max_element(origin) + 1);
  for (std::size_t v = 0; v < origin.size(); ++v)
    if (origin[v] < first && is_on_facet[v] == 0 && is_taken[origin[v]] != 0) origin[v] = next++;
}

class LayerBuilder {
 public:
  LayerBuilder(const TetMesh& input, const shape::InputSurface& surface, const LayerRules& rules, Walls walls)
      : input_(input), surface_(surface), rules_(rules), walls_(std::move(walls)), guides_(input, guide_tags(walls_)) {}

  // `bare`: by vertex, 1 where lines have no length.
  Layered attempt(const MixedMesh& mesh, const std::vector<Vertex>& origin, std::span<const std::uint8_t> bare) const;
  // Appends the columns.
  LayerCounts finish(Layered& layered) const;

 private:
  LayerCounts count(const Layered& layered) const;
  std::vector<LineIndex> too_low(const Layered& layered, const LinePoints& places) const;

  const TetMesh& input_;
  const shape::InputSurface& surface_;
  const LayerRules& rules_;
  const Walls walls_;  // not split
  const GuideSurface guides_;
};

Layered LayerBuilder::attempt(const MixedMesh& mesh, const std::vector<Vertex>& origin,
                              std::span<const std::uint8_t> bare) const {
  Layered layered{mesh, origin, walls_, plan_lines(mesh, walls_, heights_of(mesh, walls_, rules_), bare), {}};
  layered.walls.split(layered.mesh, layered.plan.grows);
  for (const Line& line : layered.walls.lines())
    if (line.tip != no_index) layered.origin.push_back(origin[line.foot]);
  std::vector<std::uint8_t> stays(input_.points.size(), 0);
  for (const Line& line : walls_.lines()) stays[origin[line.foot]] = 1;
  const shape::SlidingSurface sliding{surface_, input_.points, layered.origin, stays};
  const LinePoints places(layered.walls, layered.plan, guides_, rules_.growth);
  layered.drawn = draw_back(layered.mesh, {layered.walls, layered.plan, guides_, places, sliding, least_layer_quality});
  if (layered.drawn.stuck.empty()) layered.drawn.stuck = too_low(layered, places);
  if (layered.drawn.stuck.empty()) {
    shape::untangle(layered.mesh, untangling_rounds_behind, &sliding);
    shape::smooth(layered.mesh, rounds_behind_layers, &sliding);
  }
  return layered;
}

// Lines on which some layer is lower than least_height.
std::vector<LineIndex> LayerBuilder::too_low(const Layered& layered, const LinePoints& places) const {
  std::vector<LineIndex> result;
  for (std::size_t i = 0; i < layered.walls.lines().size(); ++i) {
    const Line& line = layered.walls.lines()[i];
    if (line.tip == no_index) continue;
    const double length = norm(layered.mesh.points[line.tip] - layered.mesh.points[line.foot]);
    if (places.lowest_share(line.layers) * length < least_height * surface_.diagonal()) result.push_back(LineIndex(i));
  }
  return result;
}

LayerCounts LayerBuilder::count(const Layered& layered) const {
  LayerCounts counts;
  for (const WallSide& side : layered.walls.sides()) {
    if (side.is_run_out) continue;
    const double area = area_of(layered.mesh, side);
    int long_lines = 0;
    double least = 1;
    for (int i = 0; i < side.size(); ++i) {
      const LineIndex line = side.lines[i];
      if (layered.walls.lines()[line].tip == no_index) continue;
      ++long_lines;
      least = std::min(least, layered.plan.room[line] * layered.drawn.shares[line]);
    }
    ++counts.facets;
    counts.area += area;
    if (long_lines == 0) {
      ++counts.bare;
      continue;
    }
    counts.area_with_some += area;
    if (long_lines == side.size()) counts.area_with_layers += area;
    if (long_lines == side.size() && least >= 0.95) counts.area_with_all += area;
    counts.least_share = std::min(counts.least_share, least);
  }
  return counts;
}

LayerCounts LayerBuilder::finish(Layered& layered) const {
  LayerCounts counts = count(layered);
  const MixedMesh& mesh = layered.mesh;
  counts.first_cells = {mesh.hexes.size(), mesh.prisms.size(), mesh.pyramids.size(), mesh.tets.size()};
  const LinePoints places(layered.walls, layered.plan, guides_, rules_.growth);
  append_columns(layered.mesh, layered.origin, layered.walls, places);
  judge_cells(mesh, counts);
  number_inner_points(layered.mesh, static_cast<Vertex>(input_.points.size()), layered.origin);
  return counts;
}

}  // namespace

void judge_cells(const MixedMesh& mesh, LayerCounts& counts) {
  counts.cells = 0;
  counts.least_quality = 1;
  counts.mean_quality = 0;
  const auto judge = [&](CellKind kind, const auto& block, std::size_t first) {
    const double scale = kind == CellKind::tet ? std::sqrt(2.0) : 1;
    for (std::size_t i = first; i < block.size(); ++i) {
      const auto at = corner_points(mesh.points, block.cells[i]);
      const double quality =
          scale * least_corner_scaled_jacobian(kind, std::span<const Vec3>(at).first(block.cells[i].size()));
      counts.least_quality = std::min(counts.least_quality, quality);
      counts.mean_quality += quality;
      ++counts.cells;
    }
  };
  judge(CellKind::hex, mesh.hexes, counts.first_cells[0]);
  judge(CellKind::prism, mesh.prisms, counts.first_cells[1]);
  judge(CellKind::pyramid, mesh.pyramids, counts.first_cells[2]);
  judge(CellKind::tet, mesh.tets, counts.first_cells[3]);
  if (counts.cells > 0) counts.mean_quality /= static_cast<double>(counts.cells);
}

LayerCounts add_layers(MixedMesh& mesh, std::vector<Vertex>& origin, const TetMesh& input,
                       const shape::InputSurface& surface, const LayerRules& rules) {
  const Step step("adding layers at walls");
  std::vector<std::uint8_t> bare(mesh.points.size(), 0);
  for (int i = 0;; ++i) {
    MixedMesh opened = mesh;
    std::vector<Vertex> opened_origin = origin;
    Walls walls = walls_with_run_outs(opened, rules.walls);
    for (int round = 0; round < most_openings; ++round) {
      if (!open_quads(opened, opened_origin, walls, lines_that_see(walls, bare))) break;
      walls = walls_with_run_outs(opened, rules.walls);
    }
    const LayerBuilder builder(input, surface, rules, std::move(walls));
    Layered layered = builder.attempt(opened, opened_origin, bare);
    if (layered.drawn.stuck.empty()) {
      const LayerCounts counts = builder.finish(layered);
      mesh = std::move(layered.mesh);
      origin = std::move(layered.origin);
      return counts;
    }
    const std::span<const Line> lines = std::as_const(layered.walls).lines();
    std::vector<std::uint8_t> is_stuck(lines.size(), 0);
    for (const LineIndex line : layered.drawn.stuck) is_stuck[line] = 1, bare[lines[line].foot] = 1;
    if (i >= attempts_without_neighbours)
      for (const LineEdge& edge : layered.walls.edges())
        if (is_stuck[edge.lines[0]] != is_stuck[edge.lines[1]])
          for (const LineIndex line : edge.lines) bare[lines[line].foot] = 1;
    if (i + 2 >= most_attempts) std::ranges::fill(bare, 1);
  }
}

}  // namespace hexpipe::assemble::layers
