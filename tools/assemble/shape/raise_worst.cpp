// A cell that no single vertex makes better, because the cells around it are at the least that they may have. These
// rise first, beyond what is good enough, and then have something to yield.

#include <algorithm>
#include <vector>

#include "common/mesh/item_lists.hpp"
#include "tools/assemble/shape/smoother.hpp"

namespace hexpipe::assemble::shape {
namespace {

// How good the cells around the worst become, so that it rises.
constexpr double goal_of_neighbours = 0.2;
// A move that raises the worst cell at its vertex by less, and a cell that rises by less in all, are not worth it.
constexpr double small_rise = 3e-4, worthy_rise = 2e-3;
constexpr int most_rounds = 30, most_rounds_in_vain = 6;
constexpr int most_raised = 8;
constexpr double rounding_of_quality = 1e-12;

}  // namespace

std::int32_t Smoother::worst_of(CellKind kind) {
  std::int32_t worst = no_index;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells_.size()); ++c)
    if (cells_.kind(c) == kind && (worst == no_index || quality_of(c) < quality_of(worst))) worst = c;
  return worst;
}

// Leaves the vertices where the cell is best, or where they were.
bool Smoother::raise(std::int32_t poor) {
  std::vector<Vertex> vertices;
  for (const Vertex v : cells_.corners_of(poor))
    for (const std::int32_t c : cells_.at(v))
      vertices.insert(vertices.end(), cells_.corners_of(c).begin(), cells_.corners_of(c).end());
  sort_unique(vertices);
  std::erase_if(vertices, [&](Vertex v) { return freedoms_[v].kind == Freedom::Kind::none && !slides(v); });
  std::vector<std::int32_t> around;
  for (const Vertex v : vertices) around.insert(around.end(), cells_.at(v).begin(), cells_.at(v).end());
  sort_unique(around);
  std::vector<double> floors;
  for (const std::int32_t c : around)
    floors.push_back(std::min(quality_of(c), cells_.kind(c) == CellKind::hex ? least_hex_quality : good_enough));
  const auto keeps_floors = [&] {
    for (std::size_t i = 0; i < around.size(); ++i)
      if (quality_of(around[i]) < floors[i] - rounding_of_quality) return false;
    return true;
  };
  const auto sum_beside_hexes = [&] {
    double sum = 0;
    for (const std::int32_t c : around) sum += cells_.kind(c) == CellKind::hex ? 0 : quality_of(c);
    return sum;
  };
  const double least_sum = sum_beside_hexes();

  std::vector<Vec3> start;
  for (const Vertex v : vertices) start.push_back(points_[v]);
  std::vector<Vec3> best = start;
  const double before = quality_of(poor);
  double reached = before;
  bool any = true;
  for (int round = 0, last = 0; any && round < most_rounds && round <= last + most_rounds_in_vain; ++round) {
    any = false;
    for (const Vertex v : vertices) {
      if (reached >= good_enough || !improve(v, goal_of_neighbours, true, goal_of_neighbours, small_rise)) continue;
      any = true;
      forget_quality_at(v);
      if (std::min(good_enough, quality_of(poor)) < reached + small_rise || !keeps_floors() ||
          sum_beside_hexes() < least_sum)
        continue;
      reached = quality_of(poor), last = round;
      for (std::size_t i = 0; i < vertices.size(); ++i) best[i] = points_[vertices[i]];
    }
    // Others may be too poor for a while, but without any rise until now none comes.
    if (round > 0 && quality_of(poor) < before + small_rise) break;
  }
  const bool is_worth_it = reached >= std::min(good_enough, before + worthy_rise);
  for (std::size_t i = 0; i < vertices.size(); ++i) points_[vertices[i]] = is_worth_it ? best[i] : start[i];
  for (const Vertex v : vertices) forget_quality_at(v);
  return is_worth_it;
}

std::int64_t Smoother::raise_worst_cells() {
  std::int64_t raised = 0;
  for (const CellKind kind : {CellKind::pyramid, CellKind::tet})
    for (int i = 0; i < most_raised; ++i) {
      const std::int32_t worst = worst_of(kind);
      if (worst == no_index || quality_of(worst) >= good_enough || !raise(worst)) break;
      ++raised;
    }
  return raised;
}

std::int64_t raise_worst_cells(MixedMesh& mesh, const SlidingSurface& sliding) {
  const auto is_poor = [&](CellKind kind, const auto& cell) {
    return quality_of(kind, mesh.points, cell) < good_enough;
  };
  // Most of the time would go into what smoothing knows of a mesh.
  if (std::ranges::none_of(mesh.pyramids.cells, [&](const auto& cell) { return is_poor(CellKind::pyramid, cell); }) &&
      std::ranges::none_of(mesh.tets.cells, [&](const auto& cell) { return is_poor(CellKind::tet, cell); }))
    return 0;
  return Smoother(mesh, &sliding, {.hex = hex_weight}).raise_worst_cells();
}

}  // namespace hexpipe::assemble::shape
