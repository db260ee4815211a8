#include "tools/assemble/layers/columns.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/assemble/hybrid/extract.hpp"

namespace hexpipe::assemble::layers {
namespace {

// The lines of a side, counter-clockwise as seen from its cell.
struct Base {
  std::array<LineIndex, 4> lines;
  int size;

  explicit Base(const WallSide& side) : lines(side.lines), size(side.size()) {
    std::reverse(lines.begin(), lines.begin() + size);
  }
  LineIndex at(int i) const { return lines[i % size]; }
};

bool has_length(const Walls& walls, LineIndex line) {
  return walls.lines()[line].tip != no_index;
}

}  // namespace

std::optional<LayerCell> layer_cell(const Walls& walls, const WallSide& side, int level) {
  const Base base(side);
  int long_lines = 0;
  for (int i = 0; i < base.size; ++i) long_lines += has_length(walls, base.lines[i]);
  if (long_lines == 0) return std::nullopt;
  const auto low = [&](int i) { return LinePoint{base.at(i), level}; };
  const auto high = [&](int i) { return LinePoint{base.at(i), level + 1}; };
  if (base.size == 4 && long_lines == 4)
    return LayerCell{CellKind::hex, {low(0), low(1), low(2), low(3), high(0), high(1), high(2), high(3)}};
  if (base.size == 3 && long_lines == 3)
    return LayerCell{CellKind::prism, {low(0), low(1), low(2), high(0), high(1), high(2)}};
  // Turns it so that the lines without length come first; a single long line comes first instead.
  const bool single = base.size == 3 && long_lines == 1;
  int first = 0;
  while (has_length(walls, base.at(first)) != single ||
         (!single && base.size == 4 && has_length(walls, base.at(first + 1))))
    ++first;
  const int a = first, b = first + 1, c = first + 2, d = first + 3;
  if (single) return LayerCell{CellKind::tet, {low(a), low(b), low(c), high(a)}};
  if (base.size == 3) return LayerCell{CellKind::pyramid, {low(b), high(b), high(c), low(c), low(a)}};
  return LayerCell{CellKind::prism, {low(a), low(d), high(d), low(b), low(c), high(c)}};
}

std::optional<LayerFacet> layer_facet(const Walls& walls, const WallSide& side, int corner, int level) {
  // Counter-clockwise as seen from the cell, the edge runs the other way.
  const LineIndex to = side.lines[corner], from = side.lines[(corner + 1) % side.size()];
  const bool from_long = has_length(walls, from), to_long = has_length(walls, to);
  if (!from_long && !to_long) return std::nullopt;
  LayerFacet facet{from_long && to_long ? 4 : 3,
                   {{{from, level}, {to, level}, {to, level + 1}, {from, level + 1}}},
                   walls.edge(from, to).tag};
  if (!to_long) facet.corners[2] = facet.corners[3];
  return facet;
}

double share_of_height(int level, int layers, double growth) {
  if (growth == 1) return static_cast<double>(level) / layers;
  return std::expm1(level * std::log(growth)) / std::expm1(layers * std::log(growth));
}

LinePoints::LinePoints(const Walls& walls, const LinePlan& plan, const GuideSurface& guides, double growth)
    : walls_(walls), plan_(plan), guides_(guides) {
  for (const WallSide& side : walls.sides()) {
    const int layers = side.layers;
    if (layers >= static_cast<int>(shares_.size())) shares_.resize(static_cast<std::size_t>(layers) + 1);
    std::vector<double>& shares = shares_[layers];
    if (!shares.empty()) continue;
    for (int level = 0; level <= layers; ++level) shares.push_back(share_of_height(level, layers, growth));
  }
}

double LinePoints::lowest_share(int layers) const {
  const std::vector<double>& shares = shares_[layers];
  return std::min(shares[1], 1 - shares[layers - 1]);
}

Vec3 LinePoints::at(std::span<const Vec3> points, const LinePoint& point) const {
  const Line& line = walls_.lines()[point.line];
  const Vec3& foot = points[line.foot];
  if (line.tip == no_index || point.level == 0) return foot;
  if (point.level == line.layers) return points[line.tip];
  const Vec3 straight = foot + (points[line.tip] - foot) * shares_[line.layers][point.level];
  return guides_.nearest(plan_.freedoms[point.line].tags, straight);
}

std::array<Vec3, 8> LinePoints::corners(std::span<const Vec3> points, const LayerCell& cell) const {
  std::array<Vec3, 8> result;
  for (int i = 0; i < corner_count(cell.kind); ++i) result[i] = at(points, cell.corners[i]);
  return result;
}

namespace {

// Points between foot and tip, which are appended line by line.
class LevelVertices {
 public:
  LevelVertices(MixedMesh& mesh, std::vector<Vertex>& origin, const Walls& walls, const LinePoints& places)
      : walls_(walls) {
    for (std::size_t i = 0; i < walls.lines().size(); ++i) {
      const Line& line = walls.lines()[i];
      first_.push_back(static_cast<Vertex>(mesh.points.size()));
      if (line.tip == no_index) continue;
      for (int level = 1; level < line.layers; ++level) {
        mesh.points.push_back(places.at(mesh.points, {LineIndex(i), level}));
        origin.push_back(origin[line.foot]);
      }
    }
  }
  Vertex of(const LinePoint& point) const {
    const Line& line = walls_.lines()[point.line];
    if (line.tip == no_index || point.level == 0) return line.foot;
    return point.level == line.layers ? line.tip : first_[point.line] + point.level - 1;
  }

 private:
  const Walls& walls_;
  std::vector<Vertex> first_;
};

}  // namespace

void append_columns(MixedMesh& mesh, std::vector<Vertex>& origin, const Walls& walls, const LinePoints& places) {
  const LevelVertices vertices(mesh, origin, walls, places);
  std::vector<std::uint8_t> is_done(walls.edges().size(), 0);
  for (const WallSide& side : walls.sides()) {
    for (int level = 0; level < side.layers; ++level) {
      const auto cell = layer_cell(walls, side, level);
      if (!cell) break;
      std::array<Vertex, 8> corners{};
      for (int i = 0; i < corner_count(cell->kind); ++i) corners[i] = vertices.of(cell->corners[i]);
      hybrid::append_cell(mesh, cell->kind, corners, side.region);
    }
    for (int corner = 0; corner < side.size(); ++corner) {
      const LineEdge& edge = walls.edge(side.lines[corner], side.lines[(corner + 1) % side.size()]);
      std::uint8_t& done = is_done[&edge - walls.edges().data()];
      if (!edge.is_tagged || done != 0) continue;
      done = 1;
      for (int level = 0; level < side.layers; ++level) {
        const auto facet = layer_facet(walls, side, corner, level);
        if (!facet) break;
        std::array<Vertex, 4> at{};
        for (int i = 0; i < facet->size; ++i) at[i] = vertices.of(facet->corners[i]);
        if (facet->size == 4)
          hybrid::append(mesh.quads, at, facet->tag);
        else
          hybrid::append(mesh.triangles, at, facet->tag);
      }
    }
  }
}

}  // namespace hexpipe::assemble::layers
