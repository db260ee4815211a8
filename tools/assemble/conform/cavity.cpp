// Splits the ring of tets around a quad's diagonal at a new vertex, so that a pyramid stands on the quad: S. J. Owen,
// S. A. Canann, S. Saigal, "Pyramid elements for maintaining tetrahedra to hexahedra conformability" (1997), and
// S. J. Owen, S. Saigal, "Formation of pyramid elements for hexahedra to tetrahedra transitions" (2001).
// They put the vertex at a fixed fraction above the quad and smooth later. Here it goes where the worst new element is
// best (point_star.hpp), and if that is poor, the cavity grows over its worst facets, as in the vertex insertion of B.
// M. Klingner, J. R. Shewchuk, "Aggressive tetrahedral mesh improvement" (2007).

#include "tools/assemble/conform/cavity.hpp"

#include <algorithm>
#include <cassert>

#include "common/mesh/quality.hpp"

namespace hexpipe::assemble::conform {
namespace {

// Ascent steps. Smoothing goes on from here: twice as many take three times as long, and after smoothing gain nothing.
constexpr int first_steps = 8;
constexpr int growth_steps = 8;
// The first few tets that are taken in help; more only cost time.
constexpr int most_growth_attempts = 24;
constexpr std::size_t most_tets = 60;

}  // namespace

Cavity::Cavity(const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, const Quad& quad, int diagonal)
    : mesh_(mesh), tags_(tags), quad_(quad), diagonal_(diagonal) {
  const Vertex a = quad[diagonal], c = quad[diagonal + 2];
  mesh.tets_around_edge(a, c, tets_);
  std::sort(tets_.begin(), tets_.end());
  assert(!tets_.empty());
  const TetIndex first = mesh.tet_at(triangles_of(quad, diagonal)[0]);
  region_ = mesh.region_of(first);
  if (!collect_skin()) obstacle_ = Obstacle::surface;
  const auto diagonal_key = edge_key(a, c);
  for (const auto& [triangle, tet] : skin_)
    for (int i = 0; i < 3; ++i)
      if (edge_key(triangle[i], triangle[(i + 1) % 3]) == diagonal_key)
        obstacle_ = tags.contains(triangle) ? Obstacle::surface : Obstacle::cells;
  if (obstacle_ == Obstacle::none && !is_sphere()) obstacle_ = Obstacle::cells;
}

Cavity::Cavity(const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, TetIndex tet)
    : mesh_(mesh), tags_(tags), region_(mesh.region_of(tet)), tets_{tet} {
  collect_skin();
}

// False if a tagged triangle or another region lies inside.
bool Cavity::collect_skin() {
  skin_.clear();
  std::vector<VertexKey<3>> keys;
  bool crossed = false;
  for (TetIndex t : tets_)
    for (const auto& f : TetTopology::triangles) {
      const Tet& tet = mesh_.tet(t);
      const Triangle triangle{tet[f[0]], tet[f[1]], tet[f[2]]};
      const auto key = key_of(triangle);
      const auto twin = std::find(keys.begin(), keys.end(), key);
      if (twin == keys.end()) {
        keys.push_back(key);
        skin_.push_back({triangle, t});
        continue;
      }
      crossed = crossed || tags_.contains(triangle) || mesh_.region_of(t) != region_;
      const auto place = twin - keys.begin();
      keys.erase(twin);
      skin_.erase(skin_.begin() + place);
    }
  if (!quad_) return !crossed;
  for (const auto& half : triangles_of(*quad_, diagonal_)) {
    const auto key = key_of(half);
    const auto found = std::find(keys.begin(), keys.end(), key);
    if (found == keys.end()) return false;
    skin_.erase(skin_.begin() + (found - keys.begin()));
    keys.erase(found);
  }
  return !crossed;
}

// Whether skin and quad are a closed surface of genus 0: every edge has two facets, and Euler's formula holds.
bool Cavity::is_sphere() const {
  std::vector<VertexKey<2>> edges;
  std::vector<Vertex> vertices;
  for (std::size_t i = 0; quad_ && i < 4; ++i) {
    edges.push_back(edge_key((*quad_)[i], (*quad_)[(i + 1) % 4]));
    vertices.push_back((*quad_)[i]);
  }
  for (const auto& facet : skin_)
    for (int i = 0; i < 3; ++i) {
      edges.push_back(edge_key(facet.triangle[i], facet.triangle[(i + 1) % 3]));
      vertices.push_back(facet.triangle[i]);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(vertices.begin(), vertices.end());
  const auto vertex_count = std::unique(vertices.begin(), vertices.end()) - vertices.begin();
  for (std::size_t i = 0; i < edges.size(); i += 2)
    if (i + 1 == edges.size() || edges[i] != edges[i + 1] || (i + 2 < edges.size() && edges[i] == edges[i + 2]))
      return false;
  const auto edge_count = static_cast<std::ptrdiff_t>(edges.size() / 2);
  const auto facet_count = static_cast<std::ptrdiff_t>(skin_.size() + (quad_ ? 1 : 0));
  return vertex_count - edge_count + facet_count == 2;
}

void Cavity::build_star() {
  star_.clear();
  auto at = [&](Vertex v) { return mesh_.points[v]; };
  if (quad_) {
    const auto& [a, b, c, d] = *quad_;
    star_.add(CellKind::pyramid, std::array<Vec3, 5>{at(a), at(b), at(c), at(d), {}}, 4);
  }
  for (const auto& [triangle, tet] : skin_) {
    const std::array<Vec3, 4> corners{at(triangle[0]), at(triangle[2]), at(triangle[1]), {}};
    star_.add(CellKind::tet, corners, 3);
  }
}

// The planes on whose inner sides all new elements are positive.
std::vector<shape::Plane> Cavity::planes() const {
  auto at = [&](Vertex v) { return mesh_.points[v]; };
  std::vector<shape::Plane> result;
  for (int diagonal = 0; quad_ && diagonal < 2; ++diagonal)
    for (const auto& [a, b, c] : triangles_of(*quad_, diagonal))
      result.push_back(shape::Plane::through(at(a), at(b), at(c)));
  for (const auto& [triangle, tet] : skin_)
    result.push_back(shape::Plane::through(at(triangle[0]), at(triangle[2]), at(triangle[1])));
  return result;
}

// Starts from the best of a few places: between the middle of the quad and the middle of the other vertices, or,
// without a quad, at the middle.
shape::Placement Cavity::search(int steps) const {
  Vec3 base{}, rest{};
  double count = 0;
  for (const auto& facet : skin_)
    for (Vertex v : facet.triangle) {
      if (quad_ && std::find(quad_->begin(), quad_->end(), v) != quad_->end()) continue;
      rest += mesh_.points[v];
      ++count;
    }
  if (count > 0) rest *= 1 / count;
  base = rest;
  if (quad_) {
    base = {};
    for (Vertex v : *quad_) base += mesh_.points[v] * 0.25;
    // A ring without other vertices is one sliver.
    if (count == 0) return {base, -1};
  }
  shape::Placement best{base, -2};
  auto consider = [&](const Vec3& at) {
    const double worst = star_.worst(at);
    if (worst > best.worst) best = {at, worst};
  };
  for (double fraction : {0.5, 0.25, 0.1}) consider(base + (rest - base) * fraction);
  if (best.worst <= 0) consider(shape::deepest_point(planes(), best.at));
  return shape::raise_worst(star_, best.at, steps);
}

std::vector<std::pair<double, Cavity::Facet>> Cavity::worst_facets(const Vec3& at) const {
  std::vector<std::pair<double, Facet>> result;
  shape::PointStar one;
  for (const auto& facet : skin_) {
    one.clear();
    const std::array<Vec3, 4> corners{mesh_.points[facet.triangle[0]], mesh_.points[facet.triangle[2]],
                                      mesh_.points[facet.triangle[1]], at};
    one.add(CellKind::tet, corners, 3);
    result.emplace_back(one.worst(at), facet);
  }
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return result;
}

// Adds the tet behind a facet of the skin. Changes nothing and returns false if there is none or the cavity would not
// be a ball.
bool Cavity::take_in(const Facet& facet) {
  if (tags_.contains(facet.triangle)) return false;
  const TetIndex behind = mesh_.tet_at(facet.triangle, facet.tet);
  if (behind == no_index || mesh_.region_of(behind) != region_) return false;
  const auto skin = skin_;
  tets_.push_back(behind);
  if (collect_skin() && is_sphere()) return true;
  tets_.pop_back();
  skin_ = skin;
  return false;
}

double Cavity::place_vertex(double enough) {
  assert(obstacle_ == Obstacle::none);
  build_star();
  shape::Placement best = search(first_steps);
  int attempts = 0;
  for (bool better = true; better && best.worst < enough && tets_.size() < most_tets;) {
    better = false;
    for (const auto& [quality, facet] : worst_facets(best.at)) {
      if (better || attempts == most_growth_attempts) break;
      const auto skin = skin_;
      if (!take_in(facet)) continue;
      ++attempts;
      build_star();
      const shape::Placement from_middle = search(growth_steps),
                             from_here = shape::raise_worst(star_, best.at, growth_steps);
      const shape::Placement& grown = from_middle.worst > from_here.worst ? from_middle : from_here;
      better = grown.worst > best.worst + 1e-3;
      if (better) {
        best = grown;
      } else {
        tets_.pop_back();
        skin_ = skin;
      }
    }
  }
  at_ = best.at;
  return best.worst;
}

double Cavity::worst_tet() const {
  double worst = 1;
  shape::PointStar one;
  for (TetIndex t : tets_) {
    one.clear();
    const auto at = corner_points(mesh_.points, mesh_.tet(t));
    one.add(CellKind::tet, std::span<const Vec3>(at).first(4), 3);
    worst = std::min(worst, one.worst(at[3]));
  }
  return worst;
}

void Cavity::split(hybrid::HybridMesh& mesh) const {
  assert(&mesh == &mesh_);
  const Vertex apex = mesh.add_point(at_);
  for (TetIndex t : tets_) mesh.remove_tet(t);
  for (const auto& [triangle, tet] : skin_) mesh.add_tet({triangle[0], triangle[2], triangle[1], apex}, region_);
  if (!quad_) return;
  const auto& [a, b, c, d] = *quad_;
  hybrid::HybridCell pyramid;
  pyramid.kind = CellKind::pyramid;
  pyramid.corners = {a, b, c, d, apex, -1, -1, -1};
  pyramid.region = region_;
  mesh.add_cell(pyramid);
}

}  // namespace hexpipe::assemble::conform
