// A row ends where the jumps around a vertex do not add up to zero. Such a vertex is a dislocation of the lattice, and
// the sum is its Burgers vector. If the jump across each edge of a path changes by that vector, the dislocation moves
// along the path to another vertex; two opposite dislocations then cancel. QuadriFlow (Huang, Zhou, Niessner, Shewchuk,
// Guibas 2018) makes the jumps of a periodic field consistent in this way on the whole surface, by a flow. Here paths
// do it, the nearest first, and ends without a partner stay.

#include "tools/tetmesh/surface/row_ends.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>

namespace hexpipe::tetmesh::surface {
namespace {

std::int32_t sign_of(bool flipped) {
  return flipped ? -1 : 1;
}

class RowJoiner {
 public:
  RowJoiner(const SurfaceLinks& links, RowJumps& jumps)
      : links_(links), jumps_(jumps), first_(links.surface.points.size(), no_index), ends_(first_.size()) {
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(jumps.size()); ++h) {
      geometry::HalfEdge& first = first_[geometry::start_of(links.surface.triangles, h)];
      if (first == no_index) first = h;
    }
    for (std::size_t v = 0; v < first_.size(); ++v) measure(static_cast<Vertex>(v));
    lengths_.resize(first_.size());
    reached_from_.resize(first_.size());
  }

  void join(double reach) {
    for (double radius = shortest_reach; radius < 2 * reach; radius *= 2)
      for (std::size_t v = 0; v < ends_.size(); ++v) join_at(static_cast<Vertex>(v), std::min(radius, reach));
  }

  std::vector<std::int32_t> counts() const {
    std::vector<std::int32_t> counts;
    for (const auto& [x, y] : ends_) counts.push_back(std::abs(x) + std::abs(y));
    return counts;
  }

 private:
  // One row that ends, as the direction of a triangle along which it is counted.
  struct End {
    std::int32_t triangle;
    FollowedAxis axis;
  };
  static constexpr double shortest_reach = 1;

  // Calls body(h) for the half-edges from a vertex, beginning with `first`, until it returns false or all were visited.
  template <class Body>
  void for_each_around(geometry::HalfEdge first, Body&& body) const {
    geometry::HalfEdge h = first;
    do {
      if (!body(h)) return;
      h = geometry::next_in_triangle(links_.surface.twins[h]);
    } while (h != first);
  }
  bool is_carrier(Vertex v) const { return first_[v] != no_index; }
  void measure(Vertex v);
  End turned_to(const End& end, Vertex v, std::int32_t triangle) const;
  bool cancels(const End& end, Vertex v) const;
  void join_at(Vertex v, double radius);
  bool join_one(Vertex v, std::size_t axis, double radius);
  std::optional<Vertex> find_partner(Vertex v, const End& end, double radius);
  void move(const End& end, geometry::HalfEdge h);

  const SurfaceLinks& links_;
  RowJumps& jumps_;
  // from each vertex; none on a feature, and where the field turns around the vertex
  std::vector<geometry::HalfEdge> first_;
  std::vector<std::array<std::int32_t, 2>> ends_;  // at each vertex, as seen from the triangle of the first half-edge
  // The state of one search: the lengths of the paths to the vertices reached, and the half-edges by which they were
  // reached.
  std::vector<std::pair<Vertex, double>> touched_;
  std::vector<double> lengths_;  // 0: not reached
  std::vector<std::pair<geometry::HalfEdge, End>> reached_from_;
};

void RowJoiner::measure(Vertex v) {
  if (first_[v] == no_index) return;
  bool is_whole = true, turns = false;
  std::array<std::int32_t, 2> sums{};
  for (std::size_t k = 0; k < 2 && is_whole; ++k) {
    FollowedAxis followed{k};
    for_each_around(first_[v], [&](geometry::HalfEdge h) {
      is_whole = links_.of[h].neighbour != no_index && links_.of[h].weight > 0;
      if (!is_whole) return false;
      sums[k] += sign_of(followed.flipped) * jumps_[h][followed.axis];
      followed.cross(links_, h);
      return true;
    });
    turns = turns || followed.axis != k || followed.flipped;
  }
  if (is_whole && !turns) {
    ends_[v] = sums;
  } else {
    first_[v] = no_index;
  }
}

// The same row as another triangle at the vertex sees it.
auto RowJoiner::turned_to(const End& end, Vertex v, std::int32_t triangle) const -> End {
  End turned = end;
  geometry::HalfEdge from = 3 * end.triangle;
  while (geometry::start_of(links_.surface.triangles, from) != v) ++from;
  for_each_around(from, [&](geometry::HalfEdge h) {
    if (geometry::triangle_of(h) == triangle) return false;
    turned.axis.cross(links_, h);
    return true;
  });
  turned.triangle = triangle;
  return turned;
}

bool RowJoiner::cancels(const End& end, Vertex v) const {
  if (ends_[v][0] == 0 && ends_[v][1] == 0) return false;
  const FollowedAxis here = turned_to(end, v, geometry::triangle_of(first_[v])).axis;
  return sign_of(here.flipped) * ends_[v][here.axis] < 0;
}

void RowJoiner::join_at(Vertex v, double radius) {
  for (std::size_t k = 0; k < 2; ++k)
    while (ends_[v][k] != 0 && join_one(v, k, radius)) {
    }
}

bool RowJoiner::join_one(Vertex v, std::size_t axis, double radius) {
  const End end{geometry::triangle_of(first_[v]), {axis, ends_[v][axis] < 0}};
  const auto partner = find_partner(v, end, radius);
  if (partner) {
    std::vector<Vertex> passed{*partner};
    for (Vertex u = *partner; u != v; passed.push_back(u)) {
      const auto& [h, moved] = reached_from_[u];
      move(moved, h);
      u = geometry::start_of(links_.surface.triangles, h);
    }
    for (const Vertex u : passed) measure(u);
  }
  for (const auto& [u, length] : touched_) lengths_[u] = 0;
  touched_.clear();
  return partner.has_value();
}

// Dijkstra's algorithm.
std::optional<Vertex> RowJoiner::find_partner(Vertex v, const End& end, double radius) {
  using Path = std::tuple<double, Vertex, geometry::HalfEdge>;
  std::priority_queue<Path, std::vector<Path>, std::greater<>> paths;
  const FieldSurface& surface = links_.surface;
  const auto offer_around = [&](Vertex u, double length) {
    for_each_around(first_[u], [&](geometry::HalfEdge h) {
      const Vertex next = geometry::end_of(surface.triangles, h);
      const double there = length + norm(surface.edge_vector(h)) / surface.sizes[geometry::triangle_of(h)];
      if (is_carrier(next) && lengths_[next] == 0 && there <= radius) paths.emplace(there, next, h);
      return true;
    });
  };
  const auto reach = [&](Vertex u, double length) {
    lengths_[u] = length;
    touched_.emplace_back(u, length);
    offer_around(u, length);
  };
  reached_from_[v] = {no_index, end};
  reach(v, 1e-12);
  while (!paths.empty()) {
    const auto [length, u, h] = paths.top();
    paths.pop();
    if (lengths_[u] > 0) continue;
    const Vertex before = geometry::start_of(surface.triangles, h);
    reached_from_[u] = {h, turned_to(reached_from_[before].second, before, geometry::triangle_of(h))};
    if (cancels(reached_from_[u].second, u)) return u;
    reach(u, length);
  }
  return std::nullopt;
}

// Moves the end of a row from the start of the half-edge to its end.
void RowJoiner::move(const End& end, geometry::HalfEdge h) {
  const SurfaceLink& link = links_.of[h];
  const std::size_t k = end.axis.axis;
  const std::int32_t change = -sign_of(end.axis.flipped);
  jumps_[h][k] += change;
  jumps_[links_.surface.twins[h]][link.axis[k]] -= sign_of(link.flipped[k]) * change;
}

}  // namespace

RowCoordinates row_coordinates(const fields::PeriodicNumbers<2>& phases) {
  RowCoordinates coordinates;
  coordinates.reserve(phases.size());
  for (const auto& [x, y] : phases) coordinates.push_back({fields::coordinate_of(x), fields::coordinate_of(y)});
  return coordinates;
}

RowJumps row_jumps(const SurfaceLinks& links, const RowCoordinates& coordinates) {
  RowJumps jumps(links.of.size());
  links.for_each_pair([&](geometry::HalfEdge h) {
    const SurfaceLink& link = links.of[h];
    for (std::size_t k = 0; k < 2; ++k) {
      const std::int32_t sign = sign_of(link.flipped[k]);
      const double there = link.seen_along(coordinates[link.neighbour], k);
      const auto jump =
          static_cast<std::int32_t>(std::lround(there + link.distance[k] - coordinates[geometry::triangle_of(h)][k]));
      jumps[h][k] = jump;
      jumps[links.surface.twins[h]][link.axis[k]] = -sign * jump;
    }
  });
  return jumps;
}

std::vector<std::int32_t> row_ends(const SurfaceLinks& links, const RowJumps& jumps) {
  RowJumps unchanged = jumps;
  return RowJoiner(links, unchanged).counts();
}

std::int64_t count_row_ends(const SurfaceLinks& links, const fields::PeriodicNumbers<2>& phases) {
  const std::vector<std::int32_t> ends = row_ends(links, row_jumps(links, row_coordinates(phases)));
  return std::accumulate(ends.begin(), ends.end(), std::int64_t{0});
}

void join_row_ends(const SurfaceLinks& links, double reach, RowJumps& jumps) {
  RowJoiner(links, jumps).join(reach);
}

}  // namespace hexpipe::tetmesh::surface
