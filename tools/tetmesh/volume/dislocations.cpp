// A line goes from tet to tet through the triangles that it pierces. The sum of the rows around a tet is the same
// through all of its facets, as that of its edges is, so that lines end at the surface and at singularities only.

#include "tools/tetmesh/volume/dislocations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "common/mesh/cell_topology.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// From the middles of tets, which go up and down along a line, to the line. It is 1.4 times as long before.
constexpr int smoothing_rounds = 10;

using RowSum = std::array<std::int32_t, 3>;

class RowCounter {
 public:
  RowCounter(const LatticeLinks& links, std::span<const std::array<double, 3>> coordinates)
      : links_(links), coordinates_(coordinates) {}

  // Rows that end in the triangle; nothing where they cannot be counted.
  std::optional<std::int32_t> ends_in(Triangle corners) const {
    std::ranges::sort(corners);
    const auto [i, j, l] = corners;
    const LinkTriangle triangle{
        .to_second = links_.between(i, j), .to_third = links_.between(i, l), .onward = links_.between(j, l)};
    if (!links_.is_regular(triangle)) return std::nullopt;
    const LatticeLink& to_second = links_[triangle.to_second];
    const RowSum first = jumps(i, triangle.to_second), second = jumps(j, triangle.onward),
                 third = jumps(i, triangle.to_third);
    std::int32_t ends = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t onward = second[to_second.axis[k]];
      ends += std::abs(first[k] + (to_second.flipped[k] ? -onward : onward) - third[k]);
    }
    return ends;
  }

 private:
  // By how many rows what the link sees of the neighbour is ahead of the node.
  RowSum jumps(std::int32_t node, std::int64_t number) const {
    const LatticeLink& link = links_[number];
    RowSum result;
    for (std::size_t k = 0; k < 3; ++k) {
      const double ahead = link.seen_along(coordinates_[link.neighbour], k) + link.distance[k] - coordinates_[node][k];
      result[k] = static_cast<std::int32_t>(std::lround(ahead));
    }
    return result;
  }

  const LatticeLinks& links_;
  std::span<const std::array<double, 3>> coordinates_;
};

class LineTracer {
 public:
  LineTracer(const LatticeLinks& links, std::span<const std::array<double, 3>> coordinates, const TetMesh& mesh,
             const TetAdjacency& adjacency)
      : links_(links),
        counter_(links, coordinates),
        mesh_(mesh),
        adjacency_(adjacency),
        stop_of_tet_(mesh.tets.size(), no_index) {}

  Dislocations trace() {
    find_pierced();
    for (const Pierced& p : pierced_) add_step(p);
    smooth();
    return measure();
  }

 private:
  struct Pierced {
    TetIndex tet, beyond;  // no_index: outside
    Triangle corners;
    std::int32_t ends;
  };
  // A stop of a line, in a tet or where it leaves the volume.
  struct Stop {
    Vec3 place;
    bool at_surface, at_singularity;
    std::int32_t steps = 0;  // to or from it
  };
  struct Step {
    std::int32_t from, to;  // stops
    std::int32_t ends;
    double size;
  };
  struct TetRows {
    std::vector<Pierced> pierced;
    std::vector<TetIndex> singular;  // tets with a facet where rows cannot be counted
  };

  Triangle corners_of(TetIndex tet, std::size_t facet) const {
    const auto& [a, b, c] = TetTopology::triangles[facet];
    const Tet& t = mesh_.tets[tet];
    return {t[a], t[b], t[c]};
  }
  void find_pierced();
  void count_in(TetIndex tet, TetRows& rows) const;
  std::int32_t stop_in(TetIndex tet);
  void add_step(const Pierced& pierced);
  void smooth();
  std::int32_t line_of(std::int32_t stop);
  Dislocations measure();

  const LatticeLinks& links_;
  RowCounter counter_;
  const TetMesh& mesh_;
  const TetAdjacency& adjacency_;
  std::vector<Pierced> pierced_;
  std::vector<bool> is_singular_;  // of tets
  std::vector<std::int32_t> stop_of_tet_;
  std::vector<Stop> stops_;
  std::vector<Step> steps_;
  std::vector<std::int32_t> lines_;  // of stops: another one of the same line
};

// Each triangle once, from the tet with the lower number.
void LineTracer::count_in(TetIndex tet, TetRows& rows) const {
  for (std::size_t facet = 0; facet < 4; ++facet) {
    const TetIndex beyond = adjacency_.tet_beyond(tet, static_cast<int>(facet));
    if (beyond != no_index && beyond < tet) continue;
    const Triangle corners = corners_of(tet, facet);
    const auto ends = counter_.ends_in(corners);
    if (!ends) {
      rows.singular.push_back(tet);
      if (beyond != no_index) rows.singular.push_back(beyond);
    } else if (*ends > 0) {
      rows.pierced.push_back({tet, beyond, corners, *ends});
    }
  }
}

void LineTracer::find_pierced() {
  is_singular_.resize(mesh_.tets.size());
  parallel_in_order(
      static_cast<std::int64_t>(mesh_.tets.size()), 2048,
      [&](std::int64_t begin, std::int64_t end) {
        TetRows rows;
        for (std::int64_t t = begin; t < end; ++t) count_in(TetIndex(t), rows);
        return rows;
      },
      [&](const TetRows& rows) {
        pierced_.insert(pierced_.end(), rows.pierced.begin(), rows.pierced.end());
        for (const TetIndex tet : rows.singular) is_singular_[tet] = true;
      });
}

std::int32_t LineTracer::stop_in(TetIndex tet) {
  if (stop_of_tet_[tet] == no_index) {
    Vec3 sum;
    for (const Vertex v : mesh_.tets[tet]) sum += mesh_.points[v];
    stop_of_tet_[tet] = static_cast<std::int32_t>(stops_.size());
    stops_.push_back({0.25 * sum, false, is_singular_[tet]});
  }
  return stop_of_tet_[tet];
}

void LineTracer::add_step(const Pierced& pierced) {
  const auto [a, b, c] = pierced.corners;
  const auto& sizes = links_.nodes().sizes;
  const std::int32_t from = stop_in(pierced.tet);
  std::int32_t to = 0;
  if (pierced.beyond == no_index) {
    to = static_cast<std::int32_t>(stops_.size());
    stops_.push_back({(mesh_.points[a] + mesh_.points[b] + mesh_.points[c]) * (1.0 / 3), true, false});
  } else {
    to = stop_in(pierced.beyond);
  }
  ++stops_[from].steps;
  ++stops_[to].steps;
  steps_.push_back({from, to, pierced.ends, (sizes[a] + sizes[b] + sizes[c]) / 3});
}

// All but the ends.
void LineTracer::smooth() {
  std::vector<Vec3> sums(stops_.size());
  for (int round = 0; round < smoothing_rounds; ++round) {
    for (std::size_t i = 0; i < stops_.size(); ++i) sums[i] = stops_[i].steps * stops_[i].place;
    for (const auto& [from, to, ends, size] : steps_) {
      sums[from] += stops_[to].place;
      sums[to] += stops_[from].place;
    }
    for (std::size_t i = 0; i < stops_.size(); ++i)
      if (stops_[i].steps > 1) stops_[i].place = sums[i] * (0.5 / stops_[i].steps);
  }
}

std::int32_t LineTracer::line_of(std::int32_t stop) {
  while (lines_[stop] != stop) stop = lines_[stop] = lines_[lines_[stop]];
  return stop;
}

Dislocations LineTracer::measure() {
  lines_.resize(stops_.size());
  std::iota(lines_.begin(), lines_.end(), 0);
  for (const Step& step : steps_) lines_[line_of(step.from)] = line_of(step.to);
  std::vector<bool> at_surface(stops_.size()), at_singularity(stops_.size());
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(stops_.size()); ++i) {
    if (stops_[i].at_surface) at_surface[line_of(i)] = true;
    if (stops_[i].at_singularity) at_singularity[line_of(i)] = true;
  }
  Dislocations result;
  for (const Step& step : steps_) {
    const Vec3 &from = stops_[step.from].place, &to = stops_[step.to].place;
    const double length = step.ends * norm(to - from) / step.size;
    const std::int32_t line = line_of(step.from);
    result.segments.push_back({from.x, from.y, from.z, to.x, to.y, to.z});
    result.length += length;
    if (at_singularity[line])
      result.at_singularities += length;
    else if (!at_surface[line])
      result.closed += length;
    if (stops_[step.to].at_surface) result.surface_ends += static_cast<std::size_t>(step.ends);
  }
  return result;
}

}  // namespace

Dislocations find_dislocations(const LatticeLinks& links, std::span<const std::array<double, 3>> coordinates,
                               const TetMesh& mesh, const TetAdjacency& adjacency) {
  return LineTracer(links, coordinates, mesh, adjacency).trace();
}

}  // namespace hexpipe::tetmesh::volume
