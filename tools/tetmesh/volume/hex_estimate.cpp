#include "tools/tetmesh/volume/estimates.hpp"

#include <tsl/robin_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/quality.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

constexpr double greatest_cosine = 0.7;  // between edges of a corner
constexpr double furthest_corner =
    0.7;  // of a corner from its place in a parallelepiped, in lengths of the longest edge
constexpr double volume_tolerance = 0.9;  // of the volume of the tets from that of the hex

constexpr std::array<unsigned, 6> quad_masks = [] {
  std::array<unsigned, 6> masks{};
  for (std::size_t q = 0; q < 6; ++q)
    for (const std::uint8_t corner : HexTopology::quads[q]) masks[q] |= 1u << corner;
  return masks;
}();

struct RoughHex {
  double quality;
  double volume;
  std::array<Vertex, 8> corners;
  std::vector<TetIndex> tets;  // interior
};

class HexSearch {
 public:
  HexSearch(const TetMesh& mesh, const TetAdjacency& adjacency) : mesh_(mesh), adjacency_(adjacency) {}

  // The hexes whose lowest vertex is `lowest`.
  void find(Vertex lowest, std::vector<RoughHex>& found);

 private:
  // The corner opposite the vertex in the quad of two of its edges, if there is one.
  struct Side {
    std::size_t first, second;  // in edges_
    Vertex opposite;
  };

  const Vec3& point(Vertex v) const { return mesh_.points[v]; }
  void collect_sides(Vertex lowest);
  bool is_square(const Vec3& a, const Vec3& b) const;
  Vertex nearest_common(std::span<const Vertex> joined, Vertex lowest, const Vec3& place, double reach) const;
  void complete(Vertex lowest, const Side& ab, const Side& ac, const Side& bc, std::vector<RoughHex>& found);
  void collect_tets(RoughHex& hex);

  const TetMesh& mesh_;
  const TetAdjacency& adjacency_;
  std::vector<Vertex> edges_;
  std::vector<Side> sides_;
  std::vector<TetIndex> tets_;
};

bool HexSearch::is_square(const Vec3& a, const Vec3& b) const {
  const double product = dot(a, b);
  return product * product < greatest_cosine * greatest_cosine * norm_squared(a) * norm_squared(b);
}

// The vertex nearest to the place among those that are neighbours of all in `joined` and greater than `lowest`.
Vertex HexSearch::nearest_common(std::span<const Vertex> joined, Vertex lowest, const Vec3& place, double reach) const {
  Vertex nearest = no_index;
  double least = reach * reach;
  const auto neighbours = adjacency_.neighbours_of(joined[0]);
  for (auto i = std::ranges::upper_bound(neighbours, lowest); i != neighbours.end(); ++i) {
    const Vertex v = *i;
    if (norm_squared(point(v) - place) >= least) continue;
    const bool is_common = std::ranges::all_of(
        joined.subspan(1), [&](Vertex other) { return v != other && adjacency_.has_edge(v, other); });
    if (!is_common) continue;
    least = norm_squared(point(v) - place);
    nearest = v;
  }
  return nearest;
}

void HexSearch::collect_sides(Vertex lowest) {
  edges_.clear();
  for (const Vertex v : adjacency_.neighbours_of(lowest))
    if (v > lowest) edges_.push_back(v);
  sides_.clear();
  const Vec3& origin = point(lowest);
  for (std::size_t i = 0; i < edges_.size(); ++i)
    for (std::size_t j = i + 1; j < edges_.size(); ++j) {
      const Vec3 a = point(edges_[i]) - origin, b = point(edges_[j]) - origin;
      if (!is_square(a, b)) continue;
      const double reach = furthest_corner * std::sqrt(std::max(norm_squared(a), norm_squared(b)));
      const Vertex opposite = nearest_common(std::array{edges_[i], edges_[j]}, lowest, origin + a + b, reach);
      if (opposite != no_index) sides_.push_back({i, j, opposite});
    }
}

void HexSearch::find(Vertex lowest, std::vector<RoughHex>& found) {
  collect_sides(lowest);
  // The sides are ordered by their first edge, so sides with the same first edge stand together.
  for (std::size_t i = 0; i < sides_.size(); ++i)
    for (std::size_t j = i + 1; j < sides_.size() && sides_[j].first == sides_[i].first; ++j) {
      const auto third = std::ranges::find_if(
          sides_, [&](const Side& s) { return s.first == sides_[i].second && s.second == sides_[j].second; });
      if (third != sides_.end()) complete(lowest, sides_[i], sides_[j], *third, found);
    }
}

void HexSearch::complete(Vertex lowest, const Side& ab, const Side& ac, const Side& bc, std::vector<RoughHex>& found) {
  Vertex a = edges_[ab.first], b = edges_[ab.second], to_a = bc.opposite, to_b = ac.opposite;
  const Vertex c = edges_[ac.second], to_c = ab.opposite;
  if (to_a == to_b || to_b == to_c || to_a == to_c) return;
  const Vec3 along_a = point(a) - point(lowest), along_b = point(b) - point(lowest), along_c = point(c) - point(lowest);
  const double reach =
      furthest_corner * std::sqrt(std::max({norm_squared(along_a), norm_squared(along_b), norm_squared(along_c)}));
  const Vec3 place = point(to_a) + point(to_b) + point(to_c) - point(a) - point(b) - point(c) + point(lowest);
  const Vertex far = nearest_common(std::array{to_a, to_b, to_c}, lowest, place, reach);
  if (far == no_index || far == a || far == b || far == c) return;
  if (det(along_a, along_b, along_c) < 0) std::swap(a, b), std::swap(to_a, to_b);
  RoughHex hex{0, 0, {lowest, a, to_c, b, c, to_b, far, to_a}, {}};
  const std::array<Vec3, 8> corners = corner_points(mesh_.points, hex.corners);
  hex.quality = least_corner_scaled_jacobian(CellKind::hex, corners);
  if (hex.quality <= least_hex_quality) return;
  collect_tets(hex);
  const double wanted = cell_volume(CellKind::hex, corners);
  if (hex.volume < volume_tolerance * wanted || wanted < volume_tolerance * hex.volume) return;
  hex.tets = tets_;
  found.push_back(std::move(hex));
}

// Collects the tets that join four of its corners, unless all four belong to one quad: such a sliver lies on the hex,
// not in it. The tets are connected through their facets.
void HexSearch::collect_tets(RoughHex& hex) {
  std::uint64_t sieve = 0;  // its bits rule out most vertices that are no corners
  for (const Vertex v : hex.corners) sieve |= std::uint64_t{1} << (v % 64);
  const auto is_inside = [&](TetIndex t) {
    unsigned corners = 0;
    for (const Vertex v : mesh_.tets[t]) {
      if ((sieve >> (v % 64) & 1) == 0) return false;
      const auto corner = std::ranges::find(hex.corners, v) - hex.corners.begin();
      if (corner == 8) return false;
      corners |= 1u << corner;
    }
    return std::ranges::find(quad_masks, corners) == quad_masks.end();
  };
  tets_.clear();
  const auto around = adjacency_.tets_at(hex.corners[0]);
  if (const auto first = std::ranges::find_if(around, is_inside); first != around.end()) tets_.push_back(*first);
  for (std::size_t i = 0; i < tets_.size(); ++i) {
    hex.volume += tet_determinant(mesh_.points, mesh_.tets[tets_[i]]) / 6;
    for (const TetIndex beyond : adjacency_.tets_beyond(tets_[i]))
      if (beyond != no_index && std::ranges::find(tets_, beyond) == tets_.end() && is_inside(beyond))
        tets_.push_back(beyond);
  }
}

// The pairs of vertices that the chosen hexes have, each with its role. Two hexes with a common pair fit together if
// the pair is an edge of both, or the diagonal of the same quad.
class ChosenPairs {
 public:
  // Adds the pairs of a hex, unless one contradicts a pair that is there.
  bool add(const RoughHex& hex) {
    std::array<std::pair<std::uint64_t, std::uint64_t>, 28> pairs;
    std::size_t count = 0;
    for (const LocalEdge& edge : HexTopology::edges) pairs[count++] = {key(hex, edge[0], edge[1]), edge_role};
    for (const LocalQuad& quad : HexTopology::quads)
      for (const std::size_t i : {0, 1})
        pairs[count++] = {key(hex, quad[i], quad[i + 2]), key(hex, quad[1 - i], quad[3 - i])};
    for (const LocalEdge& diagonal : {LocalEdge{0, 6}, {1, 7}, {2, 4}, {3, 5}})
      pairs[count++] = {key(hex, diagonal[0], diagonal[1]), inside_role};
    for (const auto& [pair, role] : pairs) {
      const auto found = roles_.find(pair);
      if (found != roles_.end() && (found->second != role || role == inside_role)) return false;
    }
    roles_.insert(pairs.begin(), pairs.end());
    return true;
  }

 private:
  // The role of a quad's diagonal is the other diagonal.
  static constexpr std::uint64_t edge_role = ~std::uint64_t{0}, inside_role = edge_role - 1;

  static std::uint64_t key(const RoughHex& hex, std::size_t i, std::size_t j) {
    const auto [low, high] = std::minmax(hex.corners[i], hex.corners[j]);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }

  tsl::robin_map<std::uint64_t, std::uint64_t, geometry::CellKeyHash> roles_;
};

std::size_t region_of(const TetMesh& mesh, TetIndex tet) {
  return mesh.tet_tags.empty() ? 0 : static_cast<std::size_t>(mesh.tet_tags[tet]);
}

// The best hexes come first. Their volumes are added to those of their regions.
void choose_greedily(const TetMesh& mesh, std::span<const RoughHex> hexes, std::vector<double>& volumes) {
  std::vector<std::int32_t> order(hexes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater(), [&](std::int32_t i) { return hexes[i].quality; });
  std::vector<bool> taken(mesh.tets.size());
  ChosenPairs pairs;
  for (const std::int32_t i : order) {
    const RoughHex& hex = hexes[i];
    const std::size_t region = region_of(mesh, hex.tets.front());
    const auto is_lost = [&](TetIndex t) { return taken[t] || region_of(mesh, t) != region; };
    if (std::ranges::any_of(hex.tets, is_lost) || !pairs.add(hex)) continue;
    for (const TetIndex t : hex.tets) taken[t] = true;
    volumes[region] += hex.volume;
  }
}

}  // namespace

double HexEstimate::share() const {
  double chosen = 0, whole = 0;
  for (const double volume : hexes) chosen += volume;
  for (const double volume : volumes) whole += volume;
  return chosen / whole;
}

HexEstimate estimate_hexes(const TetMesh& mesh, const TetAdjacency& adjacency) {
  std::vector<RoughHex> hexes;
  parallel_in_order(
      static_cast<std::int64_t>(mesh.points.size()), 256,
      [&](std::int64_t begin, std::int64_t end) {
        std::vector<RoughHex> found;
        HexSearch search(mesh, adjacency);
        for (std::int64_t v = begin; v < end; ++v) search.find(static_cast<Vertex>(v), found);
        return found;
      },
      [&](std::vector<RoughHex>&& found) { std::ranges::move(found, std::back_inserter(hexes)); });
  HexEstimate estimate;
  for (const auto t : indices<TetIndex>(mesh.tets.size())) {
    const std::size_t region = region_of(mesh, t);
    if (region >= estimate.volumes.size()) estimate.volumes.resize(region + 1);
    estimate.volumes[region] += tet_determinant(mesh.points, mesh.tets[t]) / 6;
  }
  estimate.hexes.resize(estimate.volumes.size());
  choose_greedily(mesh, hexes, estimate.hexes);
  return estimate;
}

}  // namespace hexpipe::tetmesh::volume
