// Whole numbers come first, then real coordinates. The jumps of the periodic coordinates across links are made to add
// up as far as possible. With these fixed, the coordinates are those that change the distances of the links least.
// Bommes, Zimmer, Kobbelt: Mixed-integer quadrangulation (2009) solve the same energy. Their jumps are rounded one
// after the other on a surface that is cut open; here they come from the periodic solution, which has rounded all of
// them at once.

#include "tools/tetmesh/surface/row_joining.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/surface/row_ends.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

using geometry::HalfEdge;

// The distances in sizes over which ends are joined. A face takes the first of these with which no row stretches too
// much. With 12 and 6 alone, mambo-s27 gains where it loses with these; plate-holes and mambo-m6 behave the other way
// round.
constexpr std::array<double, 4> reaches{40, 20, 12, 6};
constexpr fields::DiffusionLimits joining_limits{150, 1e-3};
// Sides that face each other count where their rows are this near to each other, in rows.
constexpr double same_row = 0.3;
constexpr double least_degree = 1e-9;

class RowStraightener {
 public:
  RowStraightener(SurfaceLinks& links, const LinksAcross& across,
                  std::span<const std::array<fields::Complex, 2>> targets, fields::PeriodicNumbers<2>& phases)
      : links_(links), across_(across), targets_(targets), phases_(phases), coordinates_(row_coordinates(phases)) {
    jumps_ = row_jumps(links, coordinates_);
    number_faces();
    are_joined_.resize(static_cast<std::size_t>(face_count_));
  }

  void run(double most_stretch) {
    const std::vector<std::int32_t> before = ends_by_face(jumps_);
    for (const double reach : reaches) try_joining(reach, most_stretch, before);
    if (std::ranges::find(are_joined_, true) == are_joined_.end()) return;
    coordinates_ = solve(jumps_, coordinates_, true);
    apply();
  }

 private:
  std::size_t size() const { return coordinates_.size(); }
  template <class Body>
  void for_each_triangle(Body&& body) const {
    parallel_for(static_cast<std::int64_t>(size()), 512, [&](std::int64_t f) { body(static_cast<std::int32_t>(f)); });
  }
  void number_faces();
  std::vector<std::int32_t> ends_by_face(const RowJumps& jumps) const;
  void try_joining(double reach, double most_stretch, const std::vector<std::int32_t>& before);
  std::vector<double> stretch_by_face(const RowJumps& jumps, const RowCoordinates& coordinates) const;
  template <class Body>
  void for_each_link(std::int32_t f, const RowJumps& jumps, const RowCoordinates& start, bool with_across,
                     Body&& body) const;
  RowCoordinates solve(const RowJumps& jumps, const RowCoordinates& start, bool with_across) const;
  double distance_between(HalfEdge h, std::size_t k, const RowJumps& jumps, const RowCoordinates& coordinates) const {
    const SurfaceLink& link = links_.of[h];
    return coordinates[geometry::triangle_of(h)][k] + jumps[h][k] - link.seen_along(coordinates[link.neighbour], k);
  }
  void apply();

  SurfaceLinks& links_;
  const LinksAcross& across_;
  std::span<const std::array<fields::Complex, 2>> targets_;
  fields::PeriodicNumbers<2>& phases_;
  RowCoordinates coordinates_;
  RowJumps jumps_;
  std::vector<std::int32_t> face_of_;  // by triangle; links join the triangles of a face
  std::int32_t face_count_ = 0;
  std::vector<bool> are_joined_;  // by face: its rows are joined
};

void RowStraightener::number_faces() {
  face_of_.assign(size(), no_index);
  std::vector<std::int32_t> queue;
  const auto reach = [&](std::int32_t f) {
    if (face_of_[f] != no_index) return;
    face_of_[f] = face_count_;
    queue.push_back(f);
  };
  for (std::int32_t seed = 0; seed < static_cast<std::int32_t>(size()); ++seed) {
    if (face_of_[seed] != no_index) continue;
    reach(seed);
    while (!queue.empty()) {
      const std::int32_t f = queue.back();
      queue.pop_back();
      for (HalfEdge h = 3 * f; h < 3 * f + 3; ++h)
        if (links_.of[h].neighbour != no_index) reach(links_.of[h].neighbour);
    }
    ++face_count_;
  }
}

// Ends are counted only at vertices within a face, so any triangle at the vertex tells the face.
std::vector<std::int32_t> RowStraightener::ends_by_face(const RowJumps& jumps) const {
  const std::vector<std::int32_t> at_vertices = row_ends(links_, jumps);
  std::vector<std::int32_t> by_face(static_cast<std::size_t>(face_count_));
  std::vector<bool> seen(at_vertices.size());
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(size()); ++f)
    for (const Vertex v : links_.surface.triangles[f]) {
      if (!seen[v]) by_face[face_of_[f]] += at_vertices[v];
      seen[v] = true;
    }
  return by_face;
}

void RowStraightener::try_joining(double reach, double most_stretch, const std::vector<std::int32_t>& before) {
  RowJumps jumps = jumps_;
  join_row_ends(links_, reach, jumps);
  const std::vector<std::int32_t> after = ends_by_face(jumps);
  const auto is_better = [&](std::int32_t face) { return !are_joined_[face] && after[face] < before[face]; };
  std::vector<bool> accepted(are_joined_.size());
  for (std::int32_t face = 0; face < face_count_; ++face) accepted[face] = is_better(face);
  if (std::ranges::find(accepted, true) == accepted.end()) return;
  const RowCoordinates coordinates = solve(jumps, coordinates_, false);
  const std::vector<double> stretch = stretch_by_face(jumps, coordinates);
  for (std::int32_t face = 0; face < face_count_; ++face) {
    accepted[face] = accepted[face] && stretch[face] <= most_stretch;
    if (accepted[face]) are_joined_[face] = true;
  }
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(size()); ++f) {
    if (!accepted[face_of_[f]]) continue;
    coordinates_[f] = coordinates[f];
    for (HalfEdge h = 3 * f; h < 3 * f + 3; ++h) jumps_[h] = jumps[h];
  }
}

std::vector<double> RowStraightener::stretch_by_face(const RowJumps& jumps, const RowCoordinates& coordinates) const {
  std::vector<double> most(static_cast<std::size_t>(face_count_));
  links_.for_each_pair([&](HalfEdge h) {
    double& of_face = most[face_of_[geometry::triangle_of(h)]];
    for (std::size_t k = 0; k < 2; ++k)
      of_face = std::max(of_face, std::abs(distance_between(h, k, jumps, coordinates) - links_.of[h].distance[k]));
  });
  return most;
}

// Calls body(link, direction, d); d is the distance to the neighbour's coordinate as it is seen, with its jump.
template <class Body>
void RowStraightener::for_each_link(std::int32_t f, const RowJumps& jumps, const RowCoordinates& start,
                                    bool with_across, Body&& body) const {
  for (HalfEdge h = 3 * f; h < 3 * f + 3; ++h) {
    if (links_.of[h].neighbour == no_index) continue;
    for (std::size_t k = 0; k < 2; ++k) body(links_.of[h], k, links_.of[h].distance[k] - jumps[h][k]);
  }
  if (!with_across) return;
  for (const SurfaceLink& link : across_.of(f))
    for (std::size_t k = 0; k < 2; ++k) {
      const double there = link.seen_along(start[link.neighbour], k);
      const double apart = start[f][k] - there - link.distance[k], rows = std::round(apart);
      if (std::abs(apart - rows) < same_row) body(link, k, link.distance[k] + rows);
    }
}

// Minimizes the squares of the changes of the distances. Coordinates that were held before are held at the nearest
// whole numbers.
RowCoordinates RowStraightener::solve(const RowJumps& jumps, const RowCoordinates& start, bool with_across) const {
  RowCoordinates degree(size());
  fields::PeriodicNumbers<2> rest(size());
  for_each_triangle([&](std::int32_t f) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double hold = std::abs(targets_[f][k]), target = fields::coordinate_of(targets_[f][k]);
      const double away = target - start[f][k];
      degree[f][k] = std::max(hold, least_degree);
      rest[f][k] = hold * (away - std::round(away));
    }
    for_each_link(f, jumps, start, with_across, [&](const SurfaceLink& link, std::size_t k, double distance) {
      const double there = link.seen_along(start[link.neighbour], k);
      degree[f][k] += link.weight;
      rest[f][k] += link.weight * (there + distance - start[f][k]);
    });
  });
  const fields::PeriodicNumbers<2> change = fields::diffused<2>(
      std::move(rest), joining_limits, [&](const auto& body) { for_each_triangle(body); },
      [&](std::size_t f, std::size_t k) { return degree[f][k]; },
      [&](const fields::PeriodicNumbers<2>& numbers, std::size_t f) {
        std::array<fields::Complex, 2> sum{};
        for_each_link(static_cast<std::int32_t>(f), jumps, start, with_across,
                      [&](const SurfaceLink& link, std::size_t k, double) {
                        const auto& [x, y] = numbers[link.neighbour];
                        sum[k] += link.weight * link.seen_along(std::array{x.real(), y.real()}, k);
                      });
        return sum;
      });
  RowCoordinates result = start;
  for (std::size_t f = 0; f < size(); ++f)
    for (std::size_t k = 0; k < 2; ++k) result[f][k] += change[f][k].real();
  return result;
}

void RowStraightener::apply() {
  links_.change_distances([&](HalfEdge h, SurfaceLink& link) {
    if (!are_joined_[face_of_[geometry::triangle_of(h)]]) return;
    for (std::size_t k = 0; k < 2; ++k) link.distance[k] = distance_between(h, k, jumps_, coordinates_);
  });
  for (std::size_t f = 0; f < size(); ++f)
    if (are_joined_[face_of_[f]])
      for (std::size_t k = 0; k < 2; ++k) phases_[f][k] = fields::number_at(coordinates_[f][k]);
}

}  // namespace

void join_rows(SurfaceLinks& links, const LinksAcross& across, std::span<const std::array<fields::Complex, 2>> targets,
               double most_stretch, fields::PeriodicNumbers<2>& phases) {
  RowStraightener(links, across, targets, phases).run(most_stretch);
}

}  // namespace hexpipe::tetmesh::surface
