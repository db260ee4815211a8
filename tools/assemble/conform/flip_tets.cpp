// Edge removal and its smallest inverse. Dynamic programming triangulates the ring of vertices around an edge so that
// the worst of the tets between its triangles and the two ends of the edge is best (G. T. Klincsek, "Minimal
// triangulations of polygonal domains", 1980). A facet is replaced by the edge between the two vertices that face it.
// L. A. Freitag, C. Ollivier-Gooch, "Tetrahedral mesh improvement using swapping and smoothing" (1997), section 2, and
// B. M. Klingner, J. R. Shewchuk, "Aggressive tetrahedral mesh improvement" (2007), section 3. Removing several facets
// at once is left out: split_flat_tets() does what is left.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/assemble/conform/flat_tets.hpp"

namespace hexpipe::assemble::conform {
namespace {

// Longer rings hardly ever have a triangulation that is better.
constexpr std::size_t longest_ring = 10;
// A smaller gain is not worth a flip. As every flip gains this much, flips come to an end.
constexpr double least_gain_of_flip = 1e-3;

// The tets that go and those that take their place.
struct Flip {
  double worst = 0;  // the quality of the worst new tet
  std::vector<TetIndex> out;
  std::vector<Tet> in;
};

class Flipper {
 public:
  Flipper(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags) : mesh_(mesh), tags_(tags) {
    for (const auto c : indices<CellIndex>(mesh.cell_count())) {
      if (!mesh.cell(c).alive) continue;
      for (int i = 0; i < mesh.cell(c).quad_count(); ++i) {
        const Quad quad = mesh.cell(c).quad(i);
        diagonals_.insert(edge_key(quad[0], quad[2]));
        diagonals_.insert(edge_key(quad[1], quad[3]));
      }
    }
  }

  std::int64_t pass(double least);

 private:
  double quality(const Tet& tet) const {
    const auto at = corner_points(mesh_.points, tet);
    return std::sqrt(2.0) * least_corner_scaled_jacobian(CellKind::tet, std::span<const Vec3>(at).first(4));
  }
  double worst_of(std::span<const TetIndex> tets) const {
    double worst = 1;
    for (TetIndex t : tets) worst = std::min(worst, quality(mesh_.tet(t)));
    return worst;
  }
  // No tet may have a diagonal of a quad as an edge: it would lie across the quad.
  bool may_join(Vertex a, Vertex b) const { return !diagonals_.contains(edge_key(a, b)); }

  std::optional<std::vector<Vertex>> ring_around(Vertex a, Vertex b);
  std::optional<Flip> without_edge(Vertex a, Vertex b, double bound);
  std::optional<Flip> without_facet(TetIndex t, int facet, double bound) const;
  std::optional<Flip> best_flip(TetIndex t);

  hybrid::HybridMesh& mesh_;
  const hybrid::SurfaceTags& tags_;
  KeySet<2> diagonals_;
  std::vector<TetIndex> around_;
};

// The vertices around edge ab in order, counter-clockwise as seen with b above a, if the tets at the edge close around
// it, lie in one region and have no tagged facets between them. Leaves the tets in around_.
std::optional<std::vector<Vertex>> Flipper::ring_around(Vertex a, Vertex b) {
  mesh_.tets_around_edge(a, b, around_);
  if (around_.size() < 3 || around_.size() > longest_ring) return std::nullopt;
  // The other two vertices of each tet, from one to the next.
  std::vector<std::array<Vertex, 2>> steps;
  for (TetIndex t : around_) {
    if (mesh_.region_of(t) != mesh_.region_of(around_[0])) return std::nullopt;
    std::array<Vertex, 2> step{};
    int count = 0;
    for (Vertex v : mesh_.tet(t))
      if (v != a && v != b) step[count++] = v;
    const Vec3 o = mesh_.points[a];
    if (det(mesh_.points[b] - o, mesh_.points[step[0]] - o, mesh_.points[step[1]] - o) < 0) std::swap(step[0], step[1]);
    steps.push_back(step);
  }
  std::vector<Vertex> ring{steps[0][0]};
  Vertex at = steps[0][1];
  while (at != ring[0]) {
    if (ring.size() == steps.size() || tags_.contains({a, b, at})) return std::nullopt;
    const auto next = std::find_if(steps.begin(), steps.end(), [&](const auto& step) { return step[0] == at; });
    if (next == steps.end()) return std::nullopt;
    ring.push_back(at);
    at = (*next)[1];
  }
  if (ring.size() != steps.size() || tags_.contains({a, b, at})) return std::nullopt;
  return ring;
}

// The best triangulation of the ring around ab; nothing if its worst tet is not better than `bound`.
std::optional<Flip> Flipper::without_edge(Vertex a, Vertex b, double bound) {
  const auto found = ring_around(a, b);
  if (!found) return std::nullopt;
  const std::vector<Vertex>& ring = *found;
  const std::size_t n = ring.size();
  // For the polygon from corner i to corner j: the worst tet of its best triangulation, and the third corner of the
  // triangle at ij.
  std::array<std::array<double, longest_ring>, longest_ring> worst{};
  std::array<std::array<std::size_t, longest_ring>, longest_ring> apex{};
  auto is_allowed = [&](std::size_t i, std::size_t j) {
    return j == i + 1 || (i == 0 && j + 1 == n) || may_join(ring[i], ring[j]);
  };
  for (std::size_t i = 0; i + 1 < n; ++i) worst[i][i + 1] = 1;
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      worst[i][j] = -1;
      if (!is_allowed(i, j)) continue;
      for (std::size_t k = i + 1; k < j; ++k) {
        double value = std::min(worst[i][k], worst[k][j]);
        if (value <= std::max(bound, worst[i][j])) continue;
        value = std::min(value, quality({ring[i], ring[j], ring[k], a}));
        if (value > std::max(bound, worst[i][j])) value = std::min(value, quality({ring[i], ring[k], ring[j], b}));
        if (value > worst[i][j]) worst[i][j] = value, apex[i][j] = k;
      }
    }
  if (worst[0][n - 1] <= bound) return std::nullopt;

  Flip flip{worst[0][n - 1], around_, {}};
  std::vector<std::array<std::size_t, 2>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j < i + 2) continue;
    const std::size_t k = apex[i][j];
    flip.in.push_back({ring[i], ring[j], ring[k], a});
    flip.in.push_back({ring[i], ring[k], ring[j], b});
    open.push_back({i, k}), open.push_back({k, j});
  }
  return flip;
}

// Three tets around a new edge in place of two at a facet of t.
std::optional<Flip> Flipper::without_facet(TetIndex t, int facet, double bound) const {
  const auto& f = TetTopology::triangles[facet];
  const Tet& tet = mesh_.tet(t);
  const Triangle triangle{tet[f[0]], tet[f[1]], tet[f[2]]};
  const TetIndex behind = mesh_.tet_at(triangle, t);
  if (behind == no_index || mesh_.region_of(behind) != mesh_.region_of(t) || tags_.contains(triangle))
    return std::nullopt;
  const Vertex here = tet[facet];
  const Tet& other = mesh_.tet(behind);
  const Vertex there = *std::find_if(other.begin(), other.end(), [&](Vertex v) {
    return std::find(triangle.begin(), triangle.end(), v) == triangle.end();
  });
  if (!may_join(here, there)) return std::nullopt;
  Flip flip{1, {t, behind}, {}};
  for (int i = 0; i < 3; ++i) {
    flip.in.push_back({triangle[i], triangle[(i + 1) % 3], here, there});
    flip.worst = std::min(flip.worst, quality(flip.in.back()));
    if (flip.worst <= bound) return std::nullopt;
  }
  return flip;
}

std::optional<Flip> Flipper::best_flip(TetIndex t) {
  std::optional<Flip> best;
  const Tet tet = mesh_.tet(t);
  const double own = quality(tet);
  auto consider = [&](std::optional<Flip>&& other) {
    if (!other || (best && other->worst <= best->worst)) return;
    const double before = worst_of(other->out);
    // Inverted tets overlap others: the tets around them do not fill a ball.
    if (before > 0 && other->worst > before + least_gain_of_flip) best = std::move(other);
  };
  for (const auto& e : TetTopology::edges) consider(without_edge(tet[e[0]], tet[e[1]], best ? best->worst : own));
  for (int facet = 0; facet < 4; ++facet) consider(without_facet(t, facet, best ? best->worst : own));
  return best;
}

std::int64_t Flipper::pass(double least) {
  std::int64_t flips = 0;
  // New tets are appended and get their turn.
  for (TetIndex t(0); static_cast<std::size_t>(t) < mesh_.tet_count(); ++t) {
    if (!mesh_.is_alive(t) || quality(mesh_.tet(t)) >= least) continue;
    const auto flip = best_flip(t);
    if (!flip) continue;
    const std::int32_t region = mesh_.region_of(t);
    for (TetIndex old : flip->out) mesh_.remove_tet(old);
    for (const Tet& tet : flip->in) mesh_.add_tet(tet, region);
    ++flips;
  }
  return flips;
}

}  // namespace

std::int64_t flip_poor_tets(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, double least) {
  Flipper flipper(mesh, tags);
  std::int64_t flips = 0;
  while (const std::int64_t more = flipper.pass(least)) flips += more;
  return flips;
}

}  // namespace hexpipe::assemble::conform
