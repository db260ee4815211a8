#include "tools/tetmesh/solid/sheets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/joined_sets.hpp"
#include "common/run/error.hpp"
#include "formats/surfaces/surface_building.hpp"
#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/solid/borders.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

using geometry::HalfEdge;

// Each triangle has two sides: 2 t is the side behind it, 2 t + 1 the side in front of it.
constexpr std::int32_t behind(std::int32_t triangle) {
  return 2 * triangle;
}
constexpr std::int32_t before(std::int32_t triangle) {
  return 2 * triangle + 1;
}

Vec3 normal_of(const formats::SurfaceSoup& soup, std::int32_t t) {
  const auto [a, b, c] = soup.triangles[t];
  return cross(soup.points[b] - soup.points[a], soup.points[c] - soup.points[a]);
}

constexpr std::size_t most_overlaps = 100'000;
constexpr int most_flip_rounds = 1000;
// Sines, and volumes over the lengths of their edges, below this count as 0: flat, or on one circle.
constexpr double flatness = 1e-9;

Vertex across_of(const formats::SurfaceSoup& soup, HalfEdge h) {
  return geometry::end_of(soup.triangles, geometry::next_in_triangle(h));
}

// Whether the common edge of two triangles in one plane should be flipped.
bool wants_flip(const formats::SurfaceSoup& soup, HalfEdge h, HalfEdge k) {
  const Vertex from = geometry::start_of(soup.triangles, h), to = geometry::end_of(soup.triangles, h);
  if (geometry::start_of(soup.triangles, k) != to) return false;
  const Vertex one = across_of(soup, h), other = across_of(soup, k);
  const Vec3 &a = soup.points[from], &b = soup.points[to], &c = soup.points[one], &d = soup.points[other];
  const Vec3 n = unit(cross(b - a, c - a));
  const double scale = norm(d - c);
  if (std::abs(dot(n, d - a)) > flatness * scale) return false;
  const auto turns = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
    return dot(cross(q - p, r - p), n) > flatness * norm(q - p) * norm(r - p);
  };
  if (!turns(a, d, c) || !turns(d, b, c)) return false;
  const auto sine = [](const Vec3& at, const Vec3& p, const Vec3& q) {
    return norm(cross(unit(p - at), unit(q - at)));
  };
  const auto cosine = [](const Vec3& at, const Vec3& p, const Vec3& q) { return dot(unit(p - at), unit(q - at)); };
  const double of_sum = sine(c, a, b) * cosine(d, a, b) + cosine(c, a, b) * sine(d, a, b);
  if (std::abs(of_sum) <= flatness) return std::min(one, other) < std::min(from, to);
  return of_sum < 0;
}

// Calls visit(side, side) for every two sides that face each other across a wedge, on a walk around an edge.
template <class Visit>
void for_each_wedge(const formats::SurfaceSoup& soup, std::span<const HalfEdge> edge, Visit&& visit) {
  const std::vector<geometry::EdgeWalkStep> steps = geometry::walk_around_edge(soup.points, soup.triangles, edge);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const geometry::EdgeWalkStep &here = steps[i], &next = steps[(i + 1) % steps.size()];
    const std::int32_t t = geometry::triangle_of(here.half_edge), u = geometry::triangle_of(next.half_edge);
    visit(here.is_along ? before(t) : behind(t), next.is_along ? behind(u) : before(u));
  }
}

class SideFinder {
 public:
  SideFinder(formats::SurfaceSoup& soup, ShellRule rule, BaffleRule baffles, std::string_view remedy)
      : soup_(soup), rule_(rule), baffles_(baffles), remedy_(remedy) {}

  SheetReport join() {
    agree_on_overlaps();
    join_repeated();
    if (!soup_.sides.empty()) {
      drop_fins();
      if (baffles_ == BaffleRule::keep) refuse_open_borders();
    }
    check_intersections(soup_, remedy_);
    return report_;
  }

  SheetReport find() {
    if (rule_ == ShellRule::holes)
      throw DataError::at(soup_.name,
                          "expected --shells oriented or regions for a surface whose sheets meet at edges of more than "
                          "two triangles, found holes");
    join();
    walk_around_edges();
    nest();
    judge_rooms();
    set_sides();
    return report_;
  }

 private:
  std::int32_t count() const { return static_cast<std::int32_t>(soup_.triangles.size()); }
  void agree_on_overlaps();
  bool flip_round(const std::vector<bool>& overlaps);
  void join_repeated();
  void walk_around_edges();
  void nest();
  std::int32_t side_below(std::int32_t component, const geometry::ColumnIndex& index) const;
  void judge_rooms();
  bool is_fin(std::int32_t t) { return rooms_->of(behind(t)) == rooms_->of(before(t)); }
  void set_sides();
  bool is_baffle(std::int32_t t) const {
    const auto [back, front] = soup_.sides[t];
    return baffles_ == BaffleRule::keep && back == front && back != outside_region;
  }
  void drop_fins();
  void refuse_open_bodies() const;
  void refuse_open_borders() const;

  formats::SurfaceSoup& soup_;
  ShellRule rule_;
  BaffleRule baffles_;
  std::string_view remedy_;
  std::vector<bool> is_interface_;        // by triangle: two bodies had it
  std::optional<JoinedSets> rooms_;       // sets of sides; the last number is the outside
  std::optional<JoinedSets> components_;  // sets of triangles, joined by common edges
  std::vector<std::int32_t> region_;      // by room; 0: nothing
  SheetReport report_;
};

// Bodies that touch in a face may cut the face into different triangles. Where these overlap, flips turn both into the
// same triangles: Delaunay triangles, and where corners lie on one circle, the diagonals at the lowest corner.
void SideFinder::agree_on_overlaps() {
  const auto found = geometry::find_intersections(soup_.points, soup_.triangles, most_overlaps);
  std::vector<bool> overlaps(soup_.triangles.size());
  for (const auto& pair : found.pairs)
    for (const std::int32_t t : pair) overlaps[t] = true;
  if (found.pairs.empty()) return;
  for (int round = 0; round < most_flip_rounds && flip_round(overlaps); ++round) {
  }
}

bool SideFinder::flip_round(const std::vector<bool>& overlaps) {
  std::vector<bool> touched(soup_.triangles.size());
  std::vector<std::array<HalfEdge, 2>> flips;
  geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    const std::int32_t t = geometry::triangle_of(edge[0]), u = geometry::triangle_of(edge[1]);
    if (!overlaps[t] || !overlaps[u] || touched[t] || touched[u] || soup_.tags[t] != soup_.tags[u]) return;
    if (!wants_flip(soup_, edge[0], edge[1])) return;
    touched[t] = touched[u] = true;
    flips.push_back({edge[0], edge[1]});
  });
  for (const auto& [h, k] : flips) {
    const Vertex a = geometry::start_of(soup_.triangles, h), b = geometry::end_of(soup_.triangles, h);
    const Vertex c = across_of(soup_, h), d = across_of(soup_, k);
    soup_.triangles[geometry::triangle_of(h)] = {a, d, c};
    soup_.triangles[geometry::triangle_of(k)] = {d, b, c};
  }
  return !flips.empty();
}

// Two bodies that touch in a face have the triangles of the face twice, with opposite orientations.
void SideFinder::join_repeated() {
  std::map<VertexKey<3>, std::int32_t> first;
  std::vector<bool> kept(soup_.triangles.size(), true);
  bool any_joined = false;
  std::size_t repeated = 0;
  std::array<std::int32_t, 2> first_repeated{};
  is_interface_.assign(soup_.triangles.size(), false);
  for (std::int32_t t = 0; t < count(); ++t) {
    const auto [known, is_new] = first.try_emplace(key_of(soup_.triangles[t]), t);
    if (is_new) continue;
    const Triangle &here = soup_.triangles[t], &other = soup_.triangles[known->second];
    const auto at = std::ranges::find(other, here[0]) - other.begin();
    if ((other[(at + 1) % 3] == here[1] || is_interface_[known->second]) && repeated++ == 0)
      first_repeated = {t, known->second};
    is_interface_[known->second] = true;
    kept[t] = false;
    // If both belong to one body, they are a fold, with the same region on both sides.
    const bool is_fold = !soup_.sides.empty() && soup_.sides[known->second][0] == soup_.sides[t][0];
    if (!soup_.sides.empty()) soup_.sides[known->second] = {soup_.sides[known->second][0], soup_.sides[t][0]};
    report_.interface_triangles += is_fold ? 0 : 1;
    any_joined = true;
  }
  if (repeated > 0)
    throw DataError::at(
        soup_.place_of(first_repeated[0]),
        "expected distinct triangles, found {} with the corners of another; the first repeats {} {} ({})", repeated,
        soup_.place_unit(), soup_.places[first_repeated[1]],
        soup_.sides.empty() ? "see --repair" : "bodies that overlap: see tessellate --overlaps");
  if (!any_joined) return;
  std::vector<bool> interfaces;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) interfaces.push_back(is_interface_[i]);
  is_interface_ = std::move(interfaces);
  keep_only(soup_, kept);
}

void SideFinder::walk_around_edges() {
  rooms_.emplace(2 * soup_.triangles.size() + 1);
  components_.emplace(soup_.triangles.size());
  geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const HalfEdge> edge) {
    for_each_wedge(soup_, edge, [&](std::int32_t one, std::int32_t other) { rooms_->join(one, other); });
    for (const HalfEdge h : edge) components_->join(geometry::triangle_of(edge[0]), geometry::triangle_of(h));
  });
}

// Finds the room around each component: the room below the first triangle above one of the component's vertices.
void SideFinder::nest() {
  const std::int32_t outside = 2 * count();
  std::map<std::int32_t, double> volumes;  // of rooms, as the triangles of one component enclose them
  for (std::int32_t t = 0; t < count(); ++t) {
    const auto [a, b, c] = soup_.triangles[t];
    const Vec3& origin = soup_.points[soup_.triangles[components_->of(t)][0]];
    const double volume = det(soup_.points[a] - origin, soup_.points[b] - origin, soup_.points[c] - origin);
    volumes[rooms_->of(behind(t))] += volume;
    volumes[rooms_->of(before(t))] -= volume;
  }
  std::map<std::int32_t, std::pair<double, std::int32_t>> around;  // by component: the room of least volume
  for (std::int32_t t = 0; t < count(); ++t)
    for (const std::int32_t side : {behind(t), before(t)}) {
      const std::int32_t room = rooms_->of(side);
      const std::pair here(volumes[room], room);
      const auto [known, is_new] = around.try_emplace(components_->of(t), here);
      if (!is_new) known->second = std::min(known->second, here);
    }
  const geometry::ColumnIndex index(soup_.points, soup_.triangles);
  std::vector<std::pair<std::int32_t, std::int32_t>> same;
  for (const auto& [component, room] : around) {
    const std::int32_t below = side_below(component, index);
    same.emplace_back(room.second, below == no_index ? outside : below);
  }
  for (const auto& [room, other] : same) rooms_->join(room, other);
}

// The side below the lowest triangle of another component above this component's first vertex, or no_index.
std::int32_t SideFinder::side_below(std::int32_t component, const geometry::ColumnIndex& index) const {
  const Vec3& p = soup_.points[soup_.triangles[component][0]];
  std::int32_t lowest = no_index;
  double least = 0;
  JoinedSets components = *components_;
  index.for_each_crossing(p, [&](std::int32_t t) {
    if (components.of(t) == component) return;
    const Vec3 n = normal_of(soup_, t);
    const Vec3& on = soup_.points[soup_.triangles[t][0]];
    const double height = n.z == 0 ? 0 : dot(n, on - p) / n.z;
    if (lowest != no_index && height >= least) return;
    least = height;
    lowest = n.z > 0 ? behind(t) : before(t);
  });
  return lowest;
}

void SideFinder::judge_rooms() {
  const std::int32_t outside = rooms_->of(2 * count());
  std::vector<bool> is_region(2 * soup_.triangles.size() + 1, rule_ == ShellRule::regions);
  std::size_t turned = 0;
  std::int32_t first_turned = no_index;
  for (std::int32_t t = 0; t < count(); ++t) {
    if (is_fin(t)) continue;
    is_region[rooms_->of(behind(t))] = true;
    if (is_interface_[t]) is_region[rooms_->of(before(t))] = true;
    if (rule_ == ShellRule::oriented && rooms_->of(behind(t)) == outside && turned++ == 0) first_turned = t;
  }
  if (turned > 0)
    throw DataError::at(
        soup_.place_of(first_turned),
        "expected triangles that point outward where sheets meet, found {} that show their backs to the "
        "outside; the first is here (see --shells regions)",
        turned);
  region_.assign(2 * soup_.triangles.size() + 1, 0);
  std::int32_t last = 0;
  for (std::int32_t t = 0; t < count(); ++t)
    for (const std::int32_t side : {behind(t), before(t)}) {
      const std::int32_t room = rooms_->of(side);
      if (is_fin(t) || room == outside || !is_region[room] || region_[room] != 0) continue;
      region_[room] = ++last;
    }
}

void SideFinder::set_sides() {
  soup_.sides.clear();
  for (std::int32_t t = 0; t < count(); ++t)
    soup_.sides.push_back({region_[rooms_->of(behind(t))], region_[rooms_->of(before(t))]});
  refuse_open_bodies();
  drop_fins();
}

// Drops triangles with the same on both sides that are no baffles, and the vertices and edges that only they have.
void SideFinder::drop_fins() {
  std::vector<bool> kept;
  std::size_t baffles = 0;
  for (std::int32_t t = 0; t < count(); ++t) {
    kept.push_back(soup_.sides[t][0] != soup_.sides[t][1] || is_baffle(t));
    baffles += is_baffle(t) ? 1 : 0;
  }
  report_.baffles = baffles;
  const auto fins = static_cast<std::size_t>(std::ranges::count(kept, false));
  if (fins == kept.size())
    throw DataError::at(soup_.name, "expected a surface that encloses something, found only sheets that do not");
  if (fins == 0) return;
  report_.fins += fins;
  keep_only(soup_, kept);
  KeySet<2> edges;
  for (const auto& [a, b, c] : soup_.triangles)
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) edges.insert(edge_key(from, to));
  formats::keep_curves_if(soup_, [&](const formats::CurveEdge& edge) { return edges.contains(key_of(edge)); });
  soup_ = formats::merge_equal_points(std::move(soup_));  // also drops the points of fins
  soup_.file_vertices.clear();
}

// Where the file tells the sides, only a baffle may end inside.
void SideFinder::refuse_open_borders() const {
  geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const HalfEdge> edge) {
    const std::int32_t t = geometry::triangle_of(edge.front());
    if (edge.size() == 1 && !is_baffle(t))
      throw DataError::at(soup_.place_of(t),
                          "expected a closed surface, found an edge of a single triangle that is no baffle");
  });
}

// The triangles of a body with a hole have the same on both sides, like fins. But such a body is larger than a sheet
// with its border could be. Files that tell the sides themselves are believed, and so are users who keep baffles: these
// may bulge.
void SideFinder::refuse_open_bodies() const {
  struct Component {
    std::size_t triangles = 0;
    double area = 0, border = 0;
    HalfEdge open = no_index;  // an edge of a single triangle
  };
  const auto has_same_on_both = [&](std::int32_t t) { return soup_.sides[t][0] == soup_.sides[t][1] && !is_baffle(t); };
  JoinedSets sets(soup_.triangles.size());
  std::vector<std::int32_t> fins;  // at an edge
  const auto find_fins = [&](std::span<const HalfEdge> edge) {
    fins.clear();
    for (const HalfEdge h : edge)
      if (has_same_on_both(geometry::triangle_of(h))) fins.push_back(geometry::triangle_of(h));
  };
  geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const HalfEdge> edge) {
    find_fins(edge);
    for (const std::int32_t fin : fins) sets.join(fins[0], fin);
  });
  std::map<std::int32_t, Component> components;
  for (std::int32_t t = 0; t < count(); ++t) {
    if (!has_same_on_both(t)) continue;
    Component& component = components[sets.of(t)];
    ++component.triangles;
    component.area += norm(normal_of(soup_, t)) / 2;
  }
  geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const HalfEdge> edge) {
    find_fins(edge);
    if (fins.size() != 1) return;
    Component& component = components[sets.of(fins[0])];
    component.border += norm(soup_.points[geometry::end_of(soup_.triangles, edge[0])] -
                             soup_.points[geometry::start_of(soup_.triangles, edge[0])]);
    if (edge.size() == 1 && (component.open == no_index || edge[0] < component.open)) component.open = edge[0];
  });
  for (const auto& [first, component] : components) {
    if (component.open == no_index || is_sheet(component.area, component.border)) continue;
    const Vec3 &from = soup_.points[geometry::start_of(soup_.triangles, component.open)],
               &to = soup_.points[geometry::end_of(soup_.triangles, component.open)];
    throw DataError::at(
        soup_.place_of(geometry::triangle_of(component.open)),
        "expected a closed surface, found {} triangles that enclose a space with a hole; an edge of the "
        "hole is from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}){}",
        component.triangles, from.x, from.y, from.z, to.x, to.y, to.z, remedy_);
  }
}

// Turns the triangles of each baffle so that neighbours agree with the first one. At edges where baffles cross or meet
// other sheets, they part.
void orient_baffles(Surface& surface) {
  std::map<std::int32_t, std::vector<std::array<HalfEdge, 2>>> edges;  // by triangle; its own half-edge comes first
  const auto is_baffle = [&](std::int32_t t) { return surface.sides[t][0] == surface.sides[t][1]; };
  geometry::for_each_edge(surface.points.size(), surface.triangles, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    const std::int32_t t = geometry::triangle_of(edge[0]), u = geometry::triangle_of(edge[1]);
    if (!is_baffle(t) || !is_baffle(u)) return;
    edges[t].push_back({edge[0], edge[1]});
    edges[u].push_back({edge[1], edge[0]});
  });
  std::vector<bool> is_seen(surface.triangles.size()), is_turned(surface.triangles.size());
  std::vector<std::int32_t> queue;
  const auto visit = [&](std::int32_t t, bool turned) {
    if (is_seen[t] && is_turned[t] != turned)
      throw DataError::at(surface.place_of(t),
                          "expected a baffle with two sides, found one that has a single side, like Möbius' strip");
    if (is_seen[t]) return;
    is_seen[t] = true;
    is_turned[t] = turned;
    queue.push_back(t);
  };
  for (const auto& [first, unused] : edges) {
    if (!is_seen[first]) visit(first, false);
    while (!queue.empty()) {
      const std::int32_t t = queue.back();
      queue.pop_back();
      for (const auto& [here, there] : edges[t]) {
        const bool agree = geometry::start_of(surface.triangles, here) == geometry::end_of(surface.triangles, there);
        visit(geometry::triangle_of(there), agree == is_turned[t]);
      }
    }
  }
  for (std::size_t t = 0; t < is_turned.size(); ++t)
    if (is_turned[t]) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
}

bool has_several_fans(const formats::SurfaceSoup& soup) {
  // Corners of one fan are one set.
  JoinedSets corners(3 * soup.triangles.size());
  geometry::for_each_edge(soup.points.size(), soup.triangles, [&](std::span<const HalfEdge> edge) {
    for (const HalfEdge other : edge)
      for (const HalfEdge h : {edge[0], geometry::next_in_triangle(edge[0])})
        for (const HalfEdge k : {other, geometry::next_in_triangle(other)})
          if (geometry::start_of(soup.triangles, h) == geometry::start_of(soup.triangles, k)) corners.join(h, k);
  });
  std::vector<std::int32_t> fan(soup.points.size(), no_index);
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(3 * soup.triangles.size()); ++h) {
    std::int32_t& known = fan[geometry::start_of(soup.triangles, h)];
    if (known != no_index && known != corners.of(h)) return true;
    known = corners.of(h);
  }
  return false;
}

// Whether the soup says that triangles have the same on both sides.
bool tells_fins(const formats::SurfaceSoup& soup) {
  return std::ranges::any_of(soup.sides, [](const auto& sides) { return sides[0] == sides[1]; });
}

bool is_boundary(const formats::SurfaceSoup& soup) {
  try {
    check_surface(soup);
    return true;
  } catch (const DataError&) {
    return false;
  }
}

}  // namespace

bool meets_in_sheets(const formats::SurfaceSoup& soup) {
  bool is_crowded = false, is_open = false;
  geometry::for_each_edge(soup.points.size(), soup.triangles, [&](std::span<const HalfEdge> edge) {
    is_crowded = is_crowded || edge.size() > 2;
    is_open = is_open || edge.size() < 2;
  });
  return is_crowded || (!is_open && has_several_fans(soup));
}

std::vector<std::string> SheetReport::sentences() const {
  std::vector<std::string> result;
  if (interface_triangles > 0)
    result.push_back(fmt::format("bodies touch: they share {} triangles that two of them had", interface_triangles));
  if (fins > 0)
    result.push_back(fmt::format("{} with the same on both sides {} left out",
                                 fins == 1 ? "a triangle" : fmt::format("{} triangles", fins),
                                 fins == 1 ? "is" : "are"));
  return result;
}

SheetReport find_sides(formats::SurfaceSoup& soup, ShellRule rule, BaffleRule baffles, std::string_view remedy) {
  return SideFinder(soup, rule, baffles, remedy).find();
}

SheetReport join_bodies(formats::SurfaceSoup& soup, BaffleRule baffles) {
  return SideFinder(soup, ShellRule::oriented, baffles, {}).join();
}

Surface find_sheets(formats::SurfaceSoup soup) {
  Surface surface{std::move(soup), {}, {}, 0, true};
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    auto& [back, front] = surface.sides[t];
    surface.region_count = std::max({surface.region_count, back, front});
    if (front == outside_region || (back != outside_region && back <= front)) continue;
    std::swap(back, front);
    std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  }
  orient_baffles(surface);
  JoinedSets sheets(surface.triangles.size());
  geometry::for_each_edge(surface.points.size(), surface.triangles, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    const std::int32_t t = geometry::triangle_of(edge[0]), u = geometry::triangle_of(edge[1]);
    if (surface.sides[t] == surface.sides[u]) sheets.join(t, u);
  });
  std::vector<std::int32_t> number(surface.triangles.size(), no_index);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::int32_t& sheet = number[sheets.of(static_cast<std::int32_t>(t))];
    if (sheet == no_index) {
      sheet = static_cast<std::int32_t>(surface.shells.size());
      Shell& made = surface.shells.emplace_back();
      made.first_triangle = static_cast<std::int32_t>(t);
      made.behind = surface.sides[t][0];
      made.in_front = surface.sides[t][1];
    }
    ++surface.shells[sheet].triangle_count;
    surface.shell_of.push_back(sheet);
  }
  choose_tags(surface);
  return surface;
}

Surface boundary_of(formats::SurfaceSoup soup, ShellRule rule, BaffleRule baffles, std::string_view remedy,
                    std::vector<std::string>& warnings, const std::function<void(formats::SurfaceSoup&)>& mend_folds) {
  const auto is_in_sheets = [&] {
    return meets_in_sheets(soup) || tells_fins(soup) || (baffles == BaffleRule::keep && has_borders(soup));
  };
  std::size_t kept = 0;
  if (is_in_sheets()) {
    check_areas(soup, remedy);
    const bool has_sides = !soup.sides.empty();
    const SheetReport found = has_sides ? join_bodies(soup, baffles) : find_sides(soup, rule, baffles, remedy);
    kept = found.baffles;
    for (const std::string& sentence : found.sentences())
      warnings.push_back(fmt::format("{}: {}", soup.name, sentence));
  }
  if (baffles == BaffleRule::keep && kept == 0)
    warnings.push_back(fmt::format("{}: --keep-baffles finds no sheet that ends inside", soup.name));
  if (is_in_sheets()) return find_sheets(std::move(soup));
  try {
    check_surface(soup, remedy);
  } catch (const SelfIntersection& intersection) {
    if (!mend_folds) throw;
    mend_folds(soup);
    if (!is_boundary(soup)) throw SelfIntersection(intersection);
  }
  return find_shells(std::move(soup), rule);
}

}  // namespace hexpipe::tetmesh::solid
