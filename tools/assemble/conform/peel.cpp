// Slivers with all vertices on a smooth surface cannot be smoothed, and no flip inside removes them, because two of
// their facets have to stay. Removing such a tet flips an edge of the surface, as do the boundary moves of M. Wicke, D.
// Ritchie, B. M. Klingner, S. Burke, J. R. Shewchuk, J. F. O'Brien, "Dynamic local remeshing for elastoplastic
// simulation" (2010), section 4.2.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/assemble/conform/flat_tets.hpp"

namespace hexpipe::assemble::conform {
namespace {

// The normals of new and old boundary facets may differ by 15 degrees.
const double least_cosine = 0.966;
// No angle of a new boundary facet has a smaller sine, unless an old one had.
constexpr double least_sine = 0.1;

// A tet with its outer edge, between the two facets on the boundary, and its inner edge between the other two.
struct Peel {
  TetIndex tet;
  std::array<Vertex, 2> outer, inner;
  std::array<hybrid::TaggedTriangle, 2> places;
  std::array<Triangle, 2> triangles;  // the boundary in their places
};

class Peeler {
 public:
  Peeler(hybrid::HybridMesh& mesh, hybrid::SurfaceTags& tags, const shape::InputSurface& surface,
         std::span<const std::uint8_t> is_shared, double least)
      : mesh_(mesh), tags_(tags), surface_(surface), is_shared_(is_shared), least_(least) {}

  std::int64_t run();

 private:
  bool is_flat(const Tet& tet) const;
  bool is_at_seam(const Tet& tet) const;
  std::optional<Peel> peel_of(TetIndex t) const;
  bool has_good_shape(const Peel& peel) const;
  void collect_obstacles(const std::vector<Peel>& peels);
  bool is_free(const Peel& peel) const;

  hybrid::HybridMesh& mesh_;
  hybrid::SurfaceTags& tags_;
  const shape::InputSurface& surface_;
  std::span<const std::uint8_t> is_shared_;
  double least_;
  KeySet<2> cell_edges_;      // and diagonals; no outer edge may be among them
  KeySet<2> boundary_edges_;  // and those of interfaces; no inner edge may be among them
  KeySet<3> halves_of_quads_;
};

bool Peeler::is_flat(const Tet& tet) const {
  const auto at = corner_points(mesh_.points, tet);
  return std::sqrt(2.0) * least_corner_scaled_jacobian(CellKind::tet, std::span<const Vec3>(at).first(4)) < least_;
}

// Whether another piece may have an edge of the tet, too.
bool Peeler::is_at_seam(const Tet& tet) const {
  return std::ranges::count_if(
             tet, [&](Vertex v) { return static_cast<std::size_t>(v) < is_shared_.size() && is_shared_[v] != 0; }) >= 2;
}

Triangle turned(const Triangle& triangle, bool turn) {
  return turn ? Triangle{triangle[0], triangle[2], triangle[1]} : triangle;
}

bool goes_around_alike(const Triangle& a, const Triangle& b) {
  const auto first = std::find(b.begin(), b.end(), a[0]) - b.begin();
  return b[static_cast<std::size_t>(first + 1) % 3] == a[1];
}

std::optional<Peel> Peeler::peel_of(TetIndex t) const {
  const Tet& tet = mesh_.tet(t);
  std::array<int, 4> order{};  // facets on the boundary first; facet i is opposite to corner i
  std::array<std::optional<hybrid::TaggedTriangle>, 4> places;
  int on_boundary = 0, inside = 3;
  for (int i = 0; i < 4; ++i) {
    const auto& f = TetTopology::triangles[i];
    places[i] = tags_.find({tet[f[0]], tet[f[1]], tet[f[2]]});
    order[places[i] ? on_boundary++ : inside--] = i;
    if (on_boundary > 2) return std::nullopt;
  }
  if (on_boundary != 2) return std::nullopt;
  Peel peel{
      t, {tet[order[2]], tet[order[3]]}, {tet[order[0]], tet[order[1]]}, {*places[order[0]], *places[order[1]]}, {}};
  if (tags_.tag_of(peel.places[0]) != tags_.tag_of(peel.places[1])) return std::nullopt;
  for (int i = 0; i < 2; ++i) {
    const auto& from = TetTopology::triangles[order[i]];
    const auto& to = TetTopology::triangles[order[2 + i]];
    const Triangle outward{tet[from[0]], tet[from[1]], tet[from[2]]};
    // Facets of the tet inside the mesh have their backs to the boundary.
    peel.triangles[i] =
        turned({tet[to[0]], tet[to[1]], tet[to[2]]}, goes_around_alike(outward, tags_.triangle(peel.places[i])));
  }
  std::vector<TetIndex> around;
  mesh_.tets_around_edge(peel.outer[0], peel.outer[1], around);
  if (around.size() != 1 || !has_good_shape(peel)) return std::nullopt;
  return peel;
}

Vec3 normal_of(std::span<const Vec3> points, const Triangle& t) {
  const Vec3 normal = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
  const double length = norm(normal);
  return normal * (length > 0 ? 1 / length : 0);
}

double least_sine_of(std::span<const Vec3> points, const Triangle& t) {
  double least = 1;
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = points[t[(i + 1) % 3]] - points[t[i]], b = points[t[(i + 2) % 3]] - points[t[i]];
    const double lengths = std::sqrt(norm_squared(a) * norm_squared(b));
    least = std::min(least, lengths > 0 ? norm(cross(a, b)) / lengths : 0);
  }
  return least;
}

bool Peeler::has_good_shape(const Peel& peel) const {
  double before = least_sine, after = 1;
  for (const hybrid::TaggedTriangle place : peel.places)
    before = std::min(before, least_sine_of(mesh_.points, tags_.triangle(place)));
  for (const auto& triangle : peel.triangles) {
    after = std::min(after, least_sine_of(mesh_.points, triangle));
    for (const hybrid::TaggedTriangle place : peel.places)
      if (dot(normal_of(mesh_.points, triangle), normal_of(mesh_.points, tags_.triangle(place))) < least_cosine)
        return false;
  }
  const Vec3 middle = (mesh_.points[peel.inner[0]] + mesh_.points[peel.inner[1]]) * 0.5;
  return after >= before && surface_.distance(peel.inner[0], middle) <= surface_.most_deviation_at(peel.inner[0]);
}

// Edges and facets that keep these tets from being peeled.
void Peeler::collect_obstacles(const std::vector<Peel>& peels) {
  KeySet<2> outer, inner;
  KeySet<3> facets;
  for (const auto& peel : peels) {
    outer.insert(edge_key(peel.outer[0], peel.outer[1]));
    inner.insert(edge_key(peel.inner[0], peel.inner[1]));
    for (const auto& triangle : peel.triangles) facets.insert(key_of(triangle));
  }
  auto take = [](const KeySet<2>& of, Vertex a, Vertex b, KeySet<2>& taken) {
    if (of.contains(edge_key(a, b))) taken.insert(edge_key(a, b));
  };
  for (const auto i : indices<hybrid::TaggedTriangle>(tags_.size()))
    for (int k = 0; k < 3; ++k) take(inner, tags_.triangle(i)[k], tags_.triangle(i)[(k + 1) % 3], boundary_edges_);
  for (const auto c : indices<CellIndex>(mesh_.cell_count())) {
    const hybrid::HybridCell& cell = mesh_.cell(c);
    if (!cell.alive) continue;
    with_topology(cell.kind, [&](auto topology) {
      for (const auto& e : decltype(topology)::edges) take(outer, cell.corners[e[0]], cell.corners[e[1]], cell_edges_);
    });
    for (int i = 0; i < cell.quad_count(); ++i)
      for (int diagonal = 0; diagonal < 2; ++diagonal) {
        const Quad quad = cell.quad(i);
        take(outer, quad[diagonal], quad[diagonal + 2], cell_edges_);
        for (const auto& half : triangles_of(quad, diagonal))
          if (facets.contains(key_of(half))) halves_of_quads_.insert(key_of(half));
      }
  }
}

bool Peeler::is_free(const Peel& peel) const {
  if (cell_edges_.contains(edge_key(peel.outer[0], peel.outer[1]))) return false;
  if (boundary_edges_.contains(edge_key(peel.inner[0], peel.inner[1]))) return false;
  return std::ranges::none_of(peel.triangles, [&](const Triangle& t) { return halves_of_quads_.contains(key_of(t)); });
}

std::int64_t Peeler::run() {
  std::vector<Peel> peels;
  for (const auto t : indices<TetIndex>(mesh_.tet_count()))
    if (mesh_.is_alive(t) && is_flat(mesh_.tet(t)) && !is_at_seam(mesh_.tet(t)))
      if (const auto peel = peel_of(t)) peels.push_back(*peel);
  if (peels.empty()) return 0;
  collect_obstacles(peels);
  std::int64_t count = 0;
  for (const auto& found : peels) {
    // Peeling another tet may have changed its facets.
    const auto peel = peel_of(found.tet);
    if (!peel || !is_free(*peel)) continue;
    tags_.peel(mesh_.tet(peel->tet), peel->places, peel->triangles);
    mesh_.remove_tet(peel->tet);
    boundary_edges_.insert(edge_key(peel->inner[0], peel->inner[1]));
    ++count;
  }
  return count;
}

}  // namespace

std::int64_t peel_flat_tets(hybrid::HybridMesh& mesh, hybrid::SurfaceTags& tags, const shape::InputSurface& surface,
                            std::span<const std::uint8_t> is_shared, double least) {
  return Peeler(mesh, tags, surface, is_shared, least).run();
}

}  // namespace hexpipe::assemble::conform
