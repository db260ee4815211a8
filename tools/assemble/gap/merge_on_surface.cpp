// An edge collapse on the boundary. Let vertex a lie on a tagged surface whose triangles at a, D, form one closed fan,
// and let D', the same with b for a, and D be graphs over one plane. The tets and pyramids of apex a at a are cones
// over a disk L, as in merge_vertices.cpp, and the cells after the merge are cones from b over the facets of L without
// b. The signed sum of their skins is L and D'; so each point lies in as many of them as L and D' wind around it. L and
// D wind once around what was filled. What lies between D and D' adds 1 where D' lies above D, and takes 1 where it
// lies below. No point above D was filled, because D is a cone from a, and a straight line from a to a point above D
// begins above D. So no point lies in two cells, where all of them are positive everywhere.

#include "tools/assemble/gap/merge_on_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "common/mesh/item_lists.hpp"
#include "tools/assemble/gap/close_gaps.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/passes.hpp"
#include "tools/assemble/gap/skin.hpp"
#include "tools/assemble/shape/nearest_points.hpp"

namespace hexpipe::assemble::gap {
namespace {

using hybrid::TaggedTriangle;
using shape::InputSurface;

// Cosines: between a facet and what it becomes, 15 degrees, as in peel.cpp; between the sides of an edge that is no
// feature, 40 degrees, as in InputSurface; between a facet and the plane that all of them lie over.
const double least_cosine = 0.966;
const double feature_cosine = std::cos(std::numbers::pi * 40 / 180);
constexpr double least_view = 0.1;
// The sine of the angles of the facets that come, unless those that go had less: as in peel.cpp.
constexpr double least_sine = 0.1;
// Passes over all vertices; few find anything after the second.
constexpr int most_surface_passes = 4;
// The sine of the angle between a move and a facet that it does not leave.
constexpr double along_surface = 1e-6;

Vec3 normal_of(std::span<const Vec3> points, const Triangle& t) {
  const Vec3 normal = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
  const double length = norm(normal);
  return normal * (length > 0 ? 1 / length : 0);
}

double sine_at(const Vec3& o, const Vec3& p, const Vec3& q) {
  const double lengths = std::sqrt(norm_squared(p - o) * norm_squared(q - o));
  return lengths > 0 ? norm(cross(p - o, q - o)) / lengths : 0;
}

double least_sine_of(std::span<const Vec3> points, const Triangle& t) {
  const Vec3 a = points[t[0]], b = points[t[1]], c = points[t[2]];
  return std::min({sine_at(a, b, c), sine_at(b, c, a), sine_at(c, a, b)});
}

bool has(const Triangle& triangle, Vertex v) {
  return std::ranges::find(triangle, v) != triangle.end();
}

Triangle with_first(const Triangle& triangle, Vertex into) {
  return {into, triangle[1], triangle[2]};
}

}  // namespace

SurfaceMerger::SurfaceMerger(GapMesh& gap, hybrid::SurfaceTags& tags, const InputSurface& surface)
    : gap_(gap), tags_(tags), surface_(surface), triangles_at_(gap.vertex_count()), gone_at_(gap.vertex_count()) {
  for (const auto i : indices<TaggedTriangle>(tags.size()))
    if (tags.find(tags.triangle(i)) == i)
      for (const Vertex v : tags.triangle(i)) triangles_at_[v].push_back(i);
  for (const auto& [from, into] : tags.merges()) move_gone(from, into);
}

std::int64_t SurfaceMerger::run() {
  std::int64_t merged = 0, before = -1;
  for (int pass = 0; pass < most_surface_passes && merged > before; ++pass) {
    before = merged;
    for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
      if (may_leave(v)) merged += merge(v) ? 1 : 0;
  }
  return merged;
}

void SurfaceMerger::move_gone(Vertex from, Vertex into) {
  auto& gone = gone_at_[into];
  gone.insert(gone.end(), gone_at_[from].begin(), gone_at_[from].end());
  gone.push_back(gap_.points()[from]);
  gone_at_[from].clear();
}

bool SurfaceMerger::may_leave(Vertex v) const {
  if (!gap_.is_free_on_surface(v) || triangles_at_[v].empty()) return false;
  const auto place = surface_.place(v);
  if (place != InputSurface::Place::face && place != InputSurface::Place::curve) return false;
  return std::ranges::all_of(gap_.cells_at(v), [&](GapIndex c) {
    const GapCell& cell = gap_.cell(c);
    return cell.kind == CellKind::tet || (cell.kind == CellKind::pyramid && cell.corners[4] == v);
  });
}

// All triangles at v as one closed fan; the input may turn some of them round, which the fan does not.
std::optional<Fan> SurfaceMerger::fan_of(Vertex v) const {
  Fan fan;
  std::vector<TaggedTriangle> rest = triangles_at_[v];
  auto others = [&](TaggedTriangle place) {
    const Triangle& t = tags_.triangle(place);
    const auto first = static_cast<std::size_t>(std::ranges::find(t, v) - t.begin());
    return std::array{t[(first + 1) % 3], t[(first + 2) % 3]};
  };
  const Vertex start = others(rest.front())[0];
  for (Vertex next = start; !rest.empty();) {
    const auto found = std::ranges::find_if(rest, [&](TaggedTriangle t) { return has(tags_.triangle(t), next); });
    if (found == rest.end()) return std::nullopt;
    const auto ends = others(*found);
    const Vertex beyond = ends[0] == next ? ends[1] : ends[0];
    fan.triangles.push_back({v, next, beyond});
    fan.places.push_back(*found);
    rest.erase(found);
    next = beyond;
    if (next == start) break;
  }
  const bool is_closed = rest.empty() && fan.triangles.back()[2] == start && fan.triangles.size() >= 3;
  return is_closed ? std::optional(fan) : std::nullopt;
}

// The neighbours on the surface; for a vertex on a curve those on the curve. Nothing where the surface around v is not
// what it was said to be.
std::vector<Vertex> SurfaceMerger::goals_of(Vertex v, const Fan& fan) const {
  std::vector<Vertex> all, on_curve;
  for (std::size_t i = 0; i < fan.triangles.size(); ++i) {
    const std::size_t k = (i + 1) % fan.triangles.size();
    all.push_back(fan.triangles[k][1]);
    const bool smooth =
        tags_.tag_of(fan.places[i]) == tags_.tag_of(fan.places[k]) &&
        dot(normal_of(gap_.points(), fan.triangles[i]), normal_of(gap_.points(), fan.triangles[k])) > feature_cosine;
    if (!smooth) on_curve.push_back(fan.triangles[k][1]);
  }
  if (surface_.place(v) == InputSurface::Place::face) return on_curve.empty() ? all : std::vector<Vertex>{};
  return on_curve.size() == 2 ? on_curve : std::vector<Vertex>{};
}

// Whether the triangle is half of a quad of some cell at `into`. Cells at both lose their quads there.
bool SurfaceMerger::is_in_quad(Vertex from, Vertex into, const Triangle& triangle) const {
  auto holds = [&](std::span<const Vertex> corners) {
    return std::ranges::all_of(triangle, [&](Vertex v) { return std::ranges::find(corners, v) != corners.end(); });
  };
  bool found = false;
  auto look = [&](CellKind kind, std::span<const Vertex> corners) {
    if (!holds(corners) || std::ranges::find(corners, from) != corners.end()) return;
    with_topology(kind, [&](auto topology) {
      for (const auto& quad : decltype(topology)::quads) {
        std::array<Vertex, 4> own{};
        for (std::size_t i = 0; i < 4; ++i) own[i] = corners[quad[i]];
        found = found || holds(own);
      }
    });
  };
  for (const GapIndex c : gap_.cells_at(into)) look(gap_.cell(c).kind, gap_.cell(c).vertices());
  for (const KeptIndex c : gap_.kept_at(into)) look(gap_.kept_cell(c).kind, gap_.kept_cell(c).vertices());
  return found;
}

// Whether a tagged triangle has both: quads on the boundary are tagged triangles, too.
bool SurfaceMerger::is_boundary_edge(Vertex into, Vertex other) const {
  return std::ranges::any_of(triangles_at_[into], [&](TaggedTriangle t) { return has(tags_.triangle(t), other); });
}

// No facet or edge is there already, and none is part of a quad.
bool SurfaceMerger::keeps_surface(Vertex from, Vertex into, const Fan& fan) const {
  std::vector<Vertex> beside;  // what shares a triangle with both
  for (const Triangle& t : fan.triangles)
    if (has(t, into)) beside.insert(beside.end(), t.begin(), t.end());
  for (const Triangle& t : fan.triangles) {
    if (has(t, into)) continue;
    const Triangle moved = with_first(t, into);
    if (tags_.contains(moved) || is_in_quad(from, into, moved)) return false;
    for (const Vertex v : {t[1], t[2]})
      if (std::ranges::find(beside, v) == beside.end() && is_boundary_edge(into, v)) return false;
  }
  return true;
}

// Both fans are graphs over a plane, and no facet turns far or becomes thin.
bool SurfaceMerger::keeps_shape(Vertex from, Vertex into, const Fan& fan) const {
  const auto points = gap_.points();
  Vec3 up{};
  for (const auto& [a, b, c] : fan.triangles) up += cross(points[b] - points[a], points[c] - points[a]);
  if (!(norm(up) > 0)) return false;
  up = unit(up);
  double around_from = 0, around_into = 0;
  for (const Triangle& t : fan.triangles) {
    const Vec3 normal = normal_of(points, t);
    if (dot(normal, up) < least_view) return false;
    auto angle_at = [&](Vertex v) {
      const Vec3 one = points[t[1]] - points[v], two = points[t[2]] - points[v];
      const Vec3 flat_one = one - up * dot(one, up), flat_two = two - up * dot(two, up);
      return std::atan2(norm(cross(flat_one, flat_two)), dot(flat_one, flat_two));
    };
    around_from += angle_at(from);
    if (has(t, into)) continue;
    const Triangle moved = with_first(t, into);
    const Vec3 after = normal_of(points, moved);
    if (dot(after, up) < least_view || dot(after, normal) < least_cosine) return false;
    if (least_sine_of(points, moved) < std::min(least_sine, least_sine_of(points, t))) return false;
    around_into += angle_at(into);
  }
  return around_from < 3 * std::numbers::pi && around_into < 2 * std::numbers::pi;
}

// From the middles of the new facets and edges to the input's surface, and from the vertices that are gone to them.
bool SurfaceMerger::stays_near(Vertex from, Vertex into, const Fan& fan) const {
  const auto points = gap_.points();
  const double most = surface_.most_deviation_at(from);
  auto is_near = [&](const Triangle& t, const Vec3& at) {
    return std::ranges::any_of(t, [&](Vertex v) { return surface_.distance(v, at, most) <= most; });
  };
  std::vector<Vec3> gone = gone_at_[from];
  gone.push_back(points[from]);
  std::vector<double> least(gone.size(), std::numeric_limits<double>::infinity());
  for (const Triangle& t : fan.triangles) {
    if (has(t, into)) continue;
    const Triangle moved = with_first(t, into);
    const Vec3 a = points[into], b = points[t[1]], c = points[t[2]];
    for (const Vec3& at : {(a + b) * 0.5, (a + c) * 0.5, (a + b + c) * (1.0 / 3)})
      if (!is_near(moved, at)) return false;
    for (std::size_t i = 0; i < gone.size(); ++i)
      least[i] = std::min(least[i], norm(shape::nearest_on_triangle({a, b, c}, gone[i]) - gone[i]));
  }
  return std::ranges::all_of(least, [&](double distance) { return distance <= most; });
}

void SurfaceMerger::look_at(Vertex from, Vertex into, Change& best) const {
  const Worth now = worth_of(gap_, gap_.cells_at(from));
  std::vector<GapCell> in;
  double cost = 0;
  for (const GapIndex c : gap_.cells_at(from)) {
    const GapCell& cell = gap_.cell(c);
    if (cell.has(into)) {
      // A pyramid loses its quad.
      if (cell.kind != CellKind::tet) return;
      continue;
    }
    auto corners = cell.corners;
    std::ranges::replace(corners, from, into);
    in.push_back(gap_.make(cell.kind, corners, cell.region));
    cost += cost_of(in.back().quality);
    if (in.back().quality < now.floor || now.cost - cost <= best.gain) return;
  }
  if (std::ranges::all_of(in, [&](const GapCell& cell) { return is_valid(gap_, cell); }))
    best = {now.cost - cost, into, std::move(in)};
}

// Appends the tagged triangle as the cell has it: as half of a quad on the surface, or as a facet.
void SurfaceMerger::append_halves(CellKind kind, std::span<const Vertex> c, const Triangle& tagged,
                                  std::vector<Facet>& sides) const {
  const auto look = [&](const Triangle& own) {
    if (std::ranges::is_permutation(own, tagged)) sides.push_back(Facet::of(own));
  };
  with_topology(kind, [&](auto topology) {
    for (const auto& t : decltype(topology)::triangles) look({c[t[0]], c[t[1]], c[t[2]]});
    for (const auto& q : decltype(topology)::quads)
      for (const int diagonal : {0, 1}) {
        const Quad quad{c[q[0]], c[q[1]], c[q[2]], c[q[3]]};
        if (tags_.cover_of(quad, diagonal))
          for (const Triangle& half : triangles_of(quad, diagonal)) look(half);
      }
  });
}

// For each facet of one cell that moves, the tet that its move takes off: see SurfaceTags::merge.
std::vector<Tet> SurfaceMerger::between(Vertex from, Vertex into, const Fan& fan) const {
  std::vector<Tet> tets;
  for (const Triangle& t : fan.triangles) {
    if (has(t, into)) continue;
    std::vector<Facet> sides;
    for (const GapIndex c : gap_.cells_at(from)) append_halves(gap_.cell(c).kind, gap_.cell(c).vertices(), t, sides);
    for (const KeptIndex k : gap_.kept_at(from))
      append_halves(gap_.kept_cell(k).kind, gap_.kept_cell(k).vertices(), t, sides);
    if (sides.size() != 1) continue;
    const auto& f = sides.front().corners;
    tets.push_back({f[0], f[2], f[1], into});
  }
  return tets;
}

bool SurfaceMerger::merge(Vertex from) {
  const auto fan = fan_of(from);
  if (!fan) return false;
  Change best;
  for (const Vertex into : goals_of(from, *fan)) {
    Change change = best;
    look_at(from, into, change);
    if (change.into != into || !keeps_surface(from, into, *fan) || !keeps_shape(from, into, *fan)) continue;
    if (stays_near(from, into, *fan)) best = std::move(change);
  }
  if (best.into == no_index) return false;
  const auto around = gap_.cells_at(from);
  const std::vector<GapIndex> out(around.begin(), around.end());
  if (cost_of_faces(gap_, best.in, out) > cost_of_faces(gap_, out) + best.gain - least_gain) return false;
  finish({{from, best.into}, *fan, between(from, best.into, *fan)});
  gap_.replace(out, best.in);
  return true;
}

void SurfaceMerger::finish(const SurfaceMerge& merge) {
  const Vertex from = merge.vertices.from, into = merge.vertices.into;
  const Fan& fan = merge.fan;
  tags_.merge(from, into, fan.places, merge.between);
  for (std::size_t i = 0; i < fan.places.size(); ++i) {
    const TaggedTriangle place = fan.places[i];
    for (const Vertex v : fan.triangles[i])
      if (has(fan.triangles[i], into)) std::erase(triangles_at_[v], place);
    if (!has(fan.triangles[i], into)) triangles_at_[into].push_back(place);
  }
  triangles_at_[from].clear();
  move_gone(from, into);
}

// Whether the surface lets `from` become `into`, which goes this part of the way to meet it, along all of its facets.
bool SurfaceMerger::may_close(Vertex from, Vertex into, const Fan& fan, double part) const {
  const Vec3 before = gap_.points()[into], shift = (gap_.points()[from] - before) * part;
  if (part > 0) {
    const auto place = surface_.place(into);
    if (place != InputSurface::Place::face && place != InputSurface::Place::curve) return false;
    for (const TaggedTriangle i : triangles_at_[into]) {
      const Triangle triangle = tags_.triangle(i);
      const Vec3 normal = normal_of(gap_.points(), triangle);
      if (std::abs(dot(normal, shift)) > along_surface * norm(shift)) return false;
      if (has(triangle, from)) continue;
      gap_.move(into, before + shift);
      const bool stays = dot(normal_of(gap_.points(), triangle), normal) > least_cosine &&
                         least_sine_of(gap_.points(), triangle) > least_sine;
      gap_.move(into, before);
      if (!stays) return false;
    }
  }
  gap_.move(into, before + shift);
  const bool keeps = keeps_surface(from, into, fan) && keeps_shape(from, into, fan) && stays_near(from, into, fan);
  gap_.move(into, before);
  return keeps;
}

std::optional<SurfaceMerge> SurfaceMerger::merge_of(Vertex from, Vertex into, double part) const {
  const auto place = surface_.place(from);
  if (place != InputSurface::Place::face && place != InputSurface::Place::curve) return std::nullopt;
  if (triangles_at_[from].empty()) return std::nullopt;
  auto fan = fan_of(from);
  if (!fan) return std::nullopt;
  const auto goals = goals_of(from, *fan);
  if (std::ranges::find(goals, into) == goals.end() || !may_close(from, into, *fan, part)) return std::nullopt;
  std::vector<Tet> taken_off = between(from, into, *fan);
  const Vec3 before = gap_.points()[into];
  return SurfaceMerge{
      {from, into, before + (gap_.points()[from] - before) * part, part > 0}, std::move(*fan), std::move(taken_off)};
}

bool SurfaceMerger::close_on_surface(Vertex a, Vertex b) {
  const auto merge = merge_of(a, b, [&](Vertex from, Vertex into) { return closer_.may_close(from, into); });
  if (!merge || !closer_.close(merge->vertices)) return false;
  finish(*merge);
  return true;
}

bool SurfaceMerger::close(Vertex a, Vertex b) {
  if (!gap_.is_inside(a) && !gap_.is_inside(b)) return close_on_surface(a, b);
  const VertexMerge merge = merge_inside(gap_, a, b);
  return closer_.may_close(merge.from, merge.into) && closer_.close(merge);
}

std::int64_t SurfaceMerger::close_gaps() {
  std::int64_t closed = 0;
  for (const auto& [a, b] : edges_across_gap(gap_)) {
    const auto has_other = [&, other = b](GapIndex c) { return gap_.cell(c).has(other); };
    if (std::ranges::any_of(gap_.cells_at(a), has_other)) closed += close(a, b) ? 1 : 0;
  }
  return closed;
}

std::int64_t merge_on_surface(GapMesh& gap, hybrid::SurfaceTags& tags, const InputSurface& surface) {
  return SurfaceMerger(gap, tags, surface).run();
}

std::int64_t close_gaps(GapMesh& gap, hybrid::SurfaceTags& tags, const InputSurface& surface) {
  return SurfaceMerger(gap, tags, surface).close_gaps();
}

}  // namespace hexpipe::assemble::gap
