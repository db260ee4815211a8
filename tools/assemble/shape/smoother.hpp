#pragma once
// What smoothing a mesh works with: one vertex after the other (smoother.cpp), and several together (raise_worst.cpp).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/vertex_items.hpp"
#include "tools/assemble/shape/boundary_deviation.hpp"
#include "tools/assemble/shape/point_star.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble::shape {

// When cells compete for a vertex, a hex of 0.5 counts as a tet or a pyramid of 0.25. Without this factor the flat
// pyramids at the border of a hex block, which cannot become much better, pull the hexes next to them down to their own
// quality (a mean of 0.92 instead of 0.96 on a block with a notch).
inline constexpr double hex_weight = 0.5;
// A smaller gain is not worth another look at the neighbours.
inline constexpr double least_gain_of_move = 1e-3;

// The least scaled Jacobian of a cell, of a tet times the square root of 2.
template <class Corners>
double quality_of(CellKind kind, std::span<const Vec3> points, const Corners& corners) {
  const auto at = corner_points(points, corners);
  const double scale = kind == CellKind::tet ? std::sqrt(2.0) : 1;
  return scale * least_corner_scaled_jacobian(kind, std::span<const Vec3>(at).first(std::size(corners)));
}

// Cells at each vertex, in flat arrays.
class Cells {
 public:
  explicit Cells(const MixedMesh& mesh) {
    auto each = [&](CellKind kind, const auto& block) {
      for (const auto& cell : block.cells) {
        kinds_.push_back(kind);
        first_.push_back(static_cast<std::int64_t>(corners_.size()));
        corners_.insert(corners_.end(), cell.begin(), cell.end());
      }
    };
    each(CellKind::hex, mesh.hexes), each(CellKind::prism, mesh.prisms);
    each(CellKind::pyramid, mesh.pyramids), each(CellKind::tet, mesh.tets);
    cells_ = VertexItems(mesh.points.size(), [&](auto&& visit) {
      for (std::int32_t c = 0; c < static_cast<std::int32_t>(kinds_.size()); ++c)
        for (Vertex v : corners_of(c)) visit(v, c);
    });
  }

  CellKind kind(std::int32_t c) const { return kinds_[c]; }
  std::span<const Vertex> corners_of(std::int32_t c) const {
    return std::span(corners_).subspan(first_[c], corner_count(kinds_[c]));
  }
  std::span<const std::int32_t> at(Vertex v) const { return cells_.at(v); }
  std::size_t size() const { return kinds_.size(); }

 private:
  std::vector<CellKind> kinds_;
  std::vector<std::int64_t> first_;
  std::vector<Vertex> corners_;
  VertexItems cells_;
};

// What the scaled Jacobians of these kinds count when cells compete for a vertex; those of others count 1.
struct KindWeights {
  double hex;
  double prism = 1;
};

class Smoother {
 public:
  Smoother(MixedMesh& mesh, const SlidingSurface* sliding, const KindWeights& weights)
      : weights_(weights),
        points_(mesh.points),
        cells_(mesh),
        freedoms_(vertex_freedoms(mesh)),
        due_(mesh.points.size(), 1),
        stays_(mesh.points.size()),
        quality_(cells_.size(), unknown) {
    if (sliding == nullptr) return;
    sliding_ = sliding;
    for (Vertex v = 0; v < static_cast<Vertex>(points_.size()); ++v)
      if (sliding->has_to_stay(v)) freedoms_[v].kind = Freedom::Kind::none;
    deviation_.emplace(mesh, sliding->surface, sliding->input_points, sliding->origin);
  }

  // From now on only vertices among hexes alone move in rounds.
  void keep_others() {
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells_.size()); ++c)
      if (cells_.kind(c) != CellKind::hex)
        for (const Vertex v : cells_.corners_of(c)) stays_[v] = 1;
  }

  // Returns the number of vertices that moved. Looks only at vertices whose worst cell, weighted or unweighted, is
  // below `only_below`.
  std::int64_t round(double only_below, bool weighted) {
    std::int64_t moves = 0;
    for (Vertex v = 0; v < static_cast<Vertex>(points_.size()); ++v) {
      if (!due_[v] || stays_[v] || (freedoms_[v].kind == Freedom::Kind::none && !slides(v))) continue;
      due_[v] = 0;
      if (!improve(v, only_below, weighted)) continue;
      ++moves;
      forget_quality_at(v);
      for (std::int32_t c : cells_.at(v))
        for (Vertex neighbour : cells_.corners_of(c)) due_[neighbour] = 1;
    }
    return moves;
  }

  // Raises the worst cell of each kind but hexes, as raise_worst_cells() says.
  std::int64_t raise_worst_cells();

  // Leaves out the vertices around which all is as it was when they settled.
  void skip(const Settled& settled) {
    const auto states = states_of_vertices();
    for (std::size_t v = 0; v < states.size(); ++v)
      if (const auto from = static_cast<std::size_t>(sliding_->origin[v]); from < settled.size())
        due_[v] = settled[from] != states[v];
  }
  void remember(Settled& settled) const {
    const auto states = states_of_vertices();
    settled.clear();
    for (std::size_t v = 0; v < states.size(); ++v) {
      const auto from = static_cast<std::size_t>(sliding_->origin[v]);
      if (from >= settled.size()) settled.resize(from + 1);
      if (due_[v] == 0) settled[from] = states[v];
    }
  }

 private:
  std::vector<std::uint64_t> states_of_vertices() const;

  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double quality_of(std::int32_t c);
  bool are_above(Vertex v, double bound, bool weighted);
  bool slides(Vertex v) const;
  Freedom freedom(Vertex v) const;
  bool stays_close(Vertex v, const Vec3& at);
  bool keeps_edges_long(Vertex v, const Vec3& at) const;
  bool leaves_surface(Vertex v, const Vec3& at) const;
  // Moves v if its worst cell is below `only_below`: where it is below `goal` to raise it, by `rise` at least.
  bool improve(Vertex v, double only_below, bool weighted, double goal = good_enough, double rise = least_gain_of_move);
  void forget_quality_at(Vertex v) {
    for (const std::int32_t c : cells_.at(v)) quality_[c] = unknown;
  }
  std::int32_t worst_of(CellKind kind);
  bool raise(std::int32_t poor);
  void look_around(Vertex v);
  CornerRules rules_of(CellKind kind) const;
  bool is_valid_cell(std::int32_t c) const;
  bool looks_inverted(std::int32_t c) const;
  Vec3 growth_at(Vertex v) const;

  KindWeights weights_;
  std::vector<Vec3>& points_;
  Cells cells_;
  std::vector<Freedom> freedoms_;
  const SlidingSurface* sliding_ = nullptr;
  std::optional<BoundaryDeviation> deviation_;
  std::vector<std::uint8_t> due_;  // something around has moved since it was looked at
  std::vector<std::uint8_t> stays_;
  std::vector<double> quality_;  // by cell
  PointStar star_;
  // While improve() looks at a vertex: its star as it is and as it would be, and cells at it that were valid, and
  // prisms that were upright.
  PointStar::Measures before_, after_;
  std::vector<std::int32_t> valid_, upright_;
};

}  // namespace hexpipe::assemble::shape
