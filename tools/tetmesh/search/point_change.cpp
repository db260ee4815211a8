#include "tools/tetmesh/search/point_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "common/mesh/cell_topology.hpp"

namespace hexpipe::tetmesh::search {
namespace {

// All in sizes.
constexpr double clearance_of_changed = 0.25;
constexpr double reach_of_move = 0.35;    // along each axis
constexpr double reach_of_middle = 0.25;  // along each axis, around a tet's middle
constexpr double unevenness = 0.05;       // of the corners of a hex, along each axis
constexpr double taken_within = 0.5;      // a point this near to a hex's corner moves to the corner
constexpr double greatest_growth = 1.3;   // of the edges of a hex, over those of the hex that it stands on

// Draws until a change can be made: most cannot on bent surfaces.
constexpr int most_draws = 4;

Vec3 random_step(double reach, Random& random) {
  const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach), z = random.uniform(-reach, reach);
  return {x, y, z};
}

// A quad of a hex, and for each of its corners the corner behind it.
struct QuadWithBack {
  std::array<std::size_t, 4> front, back;
};

constexpr std::array<QuadWithBack, 6> quads_with_back{{{{0, 1, 2, 3}, {4, 5, 6, 7}},
                                                       {{4, 5, 6, 7}, {0, 1, 2, 3}},
                                                       {{0, 1, 5, 4}, {3, 2, 6, 7}},
                                                       {{3, 2, 6, 7}, {0, 1, 5, 4}},
                                                       {{0, 3, 7, 4}, {1, 2, 6, 5}},
                                                       {{1, 2, 6, 5}, {0, 3, 7, 4}}}};

// The quad that has all corners of the triangle.
const QuadWithBack* quad_under(const ChosenHex& hex, const Triangle& triangle) {
  const auto found = std::ranges::find_if(quads_with_back, [&](const QuadWithBack& quad) {
    return std::ranges::all_of(triangle, [&](Vertex v) {
      return std::ranges::any_of(quad.front, [&](std::size_t i) { return hex.corners[i] == v; });
    });
  });
  return found == quads_with_back.end() ? nullptr : &*found;
}

}  // namespace

ChangeDrawer::ChangeDrawer(const JudgedMesh& judged, Vertex first_inside, const solid::SurfaceClearance& clearance,
                           const FlatSurface* surface)
    : judged_(judged),
      mesh_(judged.built.mesh),
      adjacency_(judged.built.adjacency),
      first_inside_(first_inside),
      clearance_(clearance),
      surface_(surface) {}

PointChange ChangeDrawer::draw(TetIndex tet, const Vec3& middle, double size, Random& random) const {
  PointChange change;
  for (int i = 0; i < most_draws && change.is_nothing(); ++i) change = draw_any(tet, middle, size, random);
  return change;
}

PointChange ChangeDrawer::draw_any(TetIndex tet, const Vec3& middle, double size, Random& random) const {
  const Tet& corners = mesh_.tets[tet];
  const std::uint64_t kind = random.below(8);
  if (kind < 2) return set_hex_on(tet, size, random);
  const Vertex v = corners[random.below(4)];
  if (!is_inside(v) && surface_ != nullptr) return change_surface(v, size, random);
  if (kind == 2 || !is_inside(v)) return add_one(middle, size, random);
  if (kind == 3) return join(v, size);
  if (kind == 4) return {{v}, {}, {}, {}};
  return move_one(v, size, random);
}

bool ChangeDrawer::is_free(const Vec3& p, double size) const {
  return clearance_.is_inside(p) && clearance_.is_clear(p, clearance_of_changed * size);
}

PointChange ChangeDrawer::move_one(Vertex v, double size, Random& random) const {
  const Vec3 place = mesh_.points[v] + random_step(reach_of_move * size, random);
  if (!is_free(place, size)) return {};
  return {{}, {{v, place}}, {}, {}};
}

PointChange ChangeDrawer::join(Vertex v, double size) const {
  const Vertex other = nearest_to(mesh_.points[v], adjacency_.neighbours_of(v), 2 * size);
  if (other == no_index || !is_inside(other)) return {{v}, {}, {}, {}};
  const Vec3 place = 0.5 * (mesh_.points[v] + mesh_.points[other]);
  if (!is_free(place, size)) return {};
  return {{other}, {{v, place}}, {}, {}};
}

PointChange ChangeDrawer::change_surface(Vertex v, double size, Random& random) const {
  const std::vector<Vertex> neighbours = surface_->neighbours_of(v);
  const Vertex other = neighbours[random.below(neighbours.size())];
  PointChange change;
  switch (random.below(4)) {
    case 0:
      change.on_surface = surface_->move(v, random_step(reach_of_move * size, random), size);
      break;
    case 1:
      change.on_surface = surface_->collapse(v, other, size);
      break;
    case 2:
      change.on_surface = surface_->split(v, other, size);
      break;
    default:
      change.on_surface = surface_->flip(v, other, size);
  }
  return change;
}

PointChange ChangeDrawer::add_one(const Vec3& middle, double size, Random& random) const {
  const Vec3 place = middle + random_step(reach_of_middle * size, random);
  if (!is_free(place, size)) return {};
  return {{}, {}, {place}, {}};
}

// On one of the tet's facets.
PointChange ChangeDrawer::set_hex_on(TetIndex tet, double size, Random& random) const {
  const auto facet = static_cast<int>(random.below(4));
  std::int32_t beside = no_index;
  Triangle triangle{};
  for (int i = 0; i < 4 && beside == no_index; ++i) {
    const int f = (facet + i) % 4;
    const TetIndex beyond = adjacency_.tet_beyond(tet, f);
    if (beyond == no_index || judged_.hex_of_tet[beyond] == no_index) continue;
    beside = judged_.hex_of_tet[beyond];
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = mesh_.tets[tet][TetTopology::triangles[f][k]];
  }
  if (beside == no_index) return {};
  const ChosenHex& hex = judged_.hexes[beside];
  const QuadWithBack* const quad = quad_under(hex, triangle);
  if (quad == nullptr) return {};
  PointChange change;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vertex front = hex.corners[quad->front[i]];
    const Vec3 out = mesh_.points[front] - mesh_.points[hex.corners[quad->back[i]]];
    const double growth = std::min(greatest_growth, size / std::sqrt(norm_squared(out)));
    const Vec3 place = mesh_.points[front] + growth * out + random_step(unevenness * size, random);
    const Vertex near = nearest_to(place, adjacency_.neighbours_of(front), taken_within * size);
    const bool is_moved = std::ranges::any_of(change.moved, [&](const auto& m) { return m.first == near; });
    if (near >= 0 && !is_inside(near)) {
      // Only one point of the surface moves: two could turn a triangle over.
      if (surface_ != nullptr && change.on_surface.is_nothing())
        change.on_surface = surface_->move(near, place - mesh_.points[near], size);
      continue;
    }
    if (is_moved || !is_free(place, size)) continue;
    if (near != no_index)
      change.moved.emplace_back(near, place);
    else
      change.added.push_back(place);
  }
  return change;
}

// Among the vertices around, or none if they are out of reach.
Vertex ChangeDrawer::nearest_to(const Vec3& place, std::span<const Vertex> around, double reach) const {
  Vertex nearest = no_index;
  double least = reach * reach;
  for (const Vertex v : around) {
    const double squared = norm_squared(mesh_.points[v] - place);
    if (squared >= least) continue;
    least = squared;
    nearest = v;
  }
  return nearest;
}

}  // namespace hexpipe::tetmesh::search
