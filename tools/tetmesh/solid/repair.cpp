#include "tools/tetmesh/solid/repair.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "common/mesh/defaults.hpp"
#include "common/run/error.hpp"
#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/solid/borders.hpp"
#include "tools/tetmesh/solid/repair_steps.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

// For --repair: a surface that moves by less than that share of its diagonal is the same for most sizes.
constexpr double repaired_share_of_diagonal = 0.002;
// Without --repair: a fifteenth of the deviation that a new surface may have from the given one.
constexpr double mended_share_of_size = 0.01;

class Repairer {
 public:
  Repairer(formats::SurfaceSoup& soup, const RepairOptions& options) : soup_(soup), options_(options) {}

  RepairReport repair() {
    weld();
    remove_degenerate();
    remove_duplicates([](const Triangle&) { return 0; });
    join_borders();
    report_.stray_triangles += remove_stray_sheets(soup_);
    orient();
    fill_holes();
    if (count() > 0)
      remove_folds({.tolerance = repaired_share_of_diagonal * geometry::Box::around(soup_.points).diagonal()});
    turn_outward();
    finish();
    return report_;
  }

  // See mend().
  RepairReport mend(BaffleRule baffles) {
    if (!is_harmed()) return report_;
    remove_degenerate();
    if (soup_.sides.empty()) {
      remove_duplicates(turn_of);
      if (baffles == BaffleRule::keep)
        join_borders();
      else
        join_all_borders();
    }
    if (report_.anything()) finish();
    return report_;
  }

  RepairReport mend_folds(double tolerance) {
    remove_folds({.tolerance = tolerance, .keeps_shape = true});
    finish();
    return report_;
  }

 private:
  void finish() {
    drop_unused_points();
    if (count() == 0) throw DataError::at(soup_.name, "expected a surface, found only triangles without area");
  }
  std::size_t count() const { return soup_.triangles.size(); }
  // Whether the corners are an even or an odd permutation of their ascending order.
  static int turn_of(const Triangle& t) { return (t[0] > t[1]) ^ (t[1] > t[2]) ^ (t[0] > t[2]); }
  Vertex corner_across(geometry::HalfEdge h) const { return geometry::corner_across(soup_.triangles, h); }
  bool is_harmed() const;
  void weld();
  void join_borders();
  void join_all_borders();
  void remove_degenerate();
  void remove_collapsed();
  bool cut_flat_triangles();
  void cut_neighbour(geometry::HalfEdge longest, std::vector<bool>& touched);
  geometry::HalfEdge longest_side(std::int32_t triangle) const;
  template <class TurnOf>
  void remove_duplicates(TurnOf&& turn_of);
  void find_twins_and_borders();
  void spread(std::int32_t start, std::vector<std::int8_t>& sides, std::vector<std::int32_t>& component) const;
  void turn(std::int32_t triangle) { std::swap(soup_.triangles[triangle][1], soup_.triangles[triangle][2]); }
  void orient();
  void fill_holes();
  void close_hole(const std::vector<geometry::HalfEdge>& border);
  void remove_folds(const FoldRule& rule);
  void turn_outward();
  void drop_unused_points();

  formats::SurfaceSoup& soup_;
  const RepairOptions& options_;
  RepairReport report_;
  std::vector<geometry::HalfEdge> twins_;  // of edges with two triangles; otherwise no_index
  std::vector<geometry::HalfEdge> borders_;
};

// Whether there are triangles without area, borders, or copies of triangles.
bool Repairer::is_harmed() const {
  for (const auto& [a, b, c] : soup_.triangles)
    if (geometry::are_collinear(soup_.points[a], soup_.points[b], soup_.points[c])) return true;
  bool harmed = false;
  geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const geometry::HalfEdge> edge) {
    harmed = harmed || edge.size() == 1;
    for (std::size_t i = 1; i < edge.size() && !harmed; ++i)
      for (std::size_t k = 0; k < i; ++k) harmed = harmed || corner_across(edge[i]) == corner_across(edge[k]);
  });
  return harmed;
}

// A point moves to the first kept point that is near and comes before it.
void Repairer::weld() {
  if (options_.tolerance <= 0 || soup_.points.empty()) return;
  geometry::SizedPointGrid kept(geometry::Box::around(soup_.points));
  std::vector<Vertex> new_index;
  new_index.reserve(soup_.points.size());
  for (const Vec3& p : soup_.points) {
    Vertex nearest = no_index;
    kept.for_each_near(p, options_.tolerance, 0, [&](std::int32_t i) {
      if (norm_squared(kept.points()[i] - p) <= options_.tolerance * options_.tolerance)
        nearest = nearest == no_index ? i : std::min(nearest, i);
      return true;
    });
    if (nearest == no_index) {
      nearest = static_cast<Vertex>(kept.points().size());
      kept.add(p, options_.tolerance);
    }
    new_index.push_back(nearest);
  }
  report_.welded_points = soup_.points.size() - kept.points().size();
  soup_.points = kept.points();
  for (Triangle& t : soup_.triangles)
    for (Vertex& v : t) v = new_index[v];
  for (formats::CurveEdge& edge : soup_.curves)
    for (Vertex& v : edge) v = new_index[v];
}

// Welding may make triangles collapse, and cutting may make copies.
void Repairer::join_borders() {
  const double tolerance = rounding_of(soup_);
  report_.welded_points += weld_borders(soup_, tolerance);
  remove_degenerate();
  report_.cut_borders += cut_at_border_points(soup_, tolerance);
  remove_duplicates(turn_of);
}

// All or none: where borders remain, the surface is refused, and the message is about the surface as it came.
void Repairer::join_all_borders() {
  find_twins_and_borders();
  if (borders_.empty()) {
    report_.stray_triangles += remove_stray_sheets(soup_);
    return;
  }
  const formats::SurfaceSoup before = soup_;
  const RepairReport report = report_;
  join_borders();
  report_.stray_triangles += remove_stray_sheets(soup_);
  find_twins_and_borders();
  if (borders_.empty()) return;
  soup_ = before;
  report_ = report;
}

void Repairer::remove_degenerate() {
  // Cutting may leave flat triangles again. After this many rounds check_surface names the rest.
  constexpr int most_rounds = 20;
  remove_collapsed();
  for (int round = 0; round < most_rounds && cut_flat_triangles(); ++round) remove_collapsed();
}

void Repairer::remove_collapsed() {
  std::vector<bool> kept(count());
  for (std::size_t t = 0; t < count(); ++t) {
    const auto [a, b, c] = soup_.triangles[t];
    kept[t] = a != b && b != c && c != a;
    report_.degenerate_triangles += !kept[t];
  }
  keep_only(soup_, kept);
}

// Removes triangles whose corners are on a line: the triangle across the longest side is cut in two at the middle
// corner. This is one round, in which each triangle changes once.
bool Repairer::cut_flat_triangles() {
  find_twins_and_borders();
  const auto old_count = static_cast<std::int32_t>(count());
  std::vector<bool> touched(count()), kept(count(), true);
  for (std::int32_t t = 0; t < old_count; ++t) {
    const auto [a, b, c] = soup_.triangles[t];
    if (touched[t] || !geometry::are_collinear(soup_.points[a], soup_.points[b], soup_.points[c])) continue;
    const geometry::HalfEdge longest = longest_side(t), twin = twins_[longest];
    if (twin != no_index && touched[geometry::triangle_of(twin)]) continue;
    kept[t] = false;
    touched[t] = true;
    ++report_.degenerate_triangles;
    if (twin != no_index) cut_neighbour(longest, touched);
  }
  const bool removed = std::ranges::find(kept, false) != kept.end();
  kept.resize(count(), true);
  keep_only(soup_, kept);
  return removed;
}

geometry::HalfEdge Repairer::longest_side(std::int32_t triangle) const {
  const auto squared = [&](geometry::HalfEdge h) {
    return norm_squared(soup_.points[geometry::end_of(soup_.triangles, h)] -
                        soup_.points[geometry::start_of(soup_.triangles, h)]);
  };
  const auto is_shorter = [&](geometry::HalfEdge a, geometry::HalfEdge b) { return squared(a) < squared(b); };
  return std::max({3 * triangle, 3 * triangle + 1, 3 * triangle + 2}, is_shorter);
}

void Repairer::cut_neighbour(geometry::HalfEdge longest, std::vector<bool>& touched) {
  const geometry::HalfEdge twin = twins_[longest];
  const std::int32_t neighbour = geometry::triangle_of(twin);
  const Vertex middle = corner_across(longest);
  Triangle other = soup_.triangles[neighbour];
  other[twin % 3] = middle;
  soup_.triangles[neighbour][geometry::next_in_triangle(twin) % 3] = middle;
  soup_.triangles.push_back(other);
  soup_.tags.push_back(soup_.tags[neighbour]);
  soup_.places.push_back(soup_.places[neighbour]);
  if (!soup_.sides.empty()) soup_.sides.push_back(soup_.sides[neighbour]);
  touched[neighbour] = true;
}

// Triangles with the same corners are one if they turn the same way.
template <class TurnOf>
void Repairer::remove_duplicates(TurnOf&& turn_of) {
  const auto key = [&](std::int32_t t) {
    Triangle corners = soup_.triangles[t];
    const int turn = turn_of(corners);
    std::ranges::sort(corners);
    return std::pair(std::pair(corners, turn), t);
  };
  std::vector<std::int32_t> order(count());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, key);
  std::vector<bool> kept(count(), true);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i]).first == key(order[i - 1]).first) kept[order[i]] = false;
  report_.duplicate_triangles += static_cast<std::size_t>(std::ranges::count(kept, false));
  keep_only(soup_, kept);
}

void Repairer::find_twins_and_borders() {
  twins_.assign(3 * count(), no_index);
  borders_.clear();
  geometry::for_each_edge(soup_.points.size(), soup_.triangles, [&](std::span<const geometry::HalfEdge> edge) {
    if (edge.size() == 1) borders_.push_back(edge[0]);
    if (edge.size() != 2) return;
    twins_[edge[0]] = edge[1];
    twins_[edge[1]] = edge[0];
  });
}

// Walks from one triangle over the edges of two triangles. The side is 1 for triangles that show the same side as the
// first one, -1 for the others.
void Repairer::spread(std::int32_t start, std::vector<std::int8_t>& sides, std::vector<std::int32_t>& component) const {
  component.assign(1, start);
  sides[start] = 1;
  for (std::size_t i = 0; i < component.size(); ++i)
    for (geometry::HalfEdge h = 3 * component[i]; h < 3 * component[i] + 3; ++h) {
      if (twins_[h] == no_index || sides[geometry::triangle_of(twins_[h])] != 0) continue;
      const bool agree = geometry::start_of(soup_.triangles, h) == geometry::end_of(soup_.triangles, twins_[h]);
      const std::int8_t side = sides[component[i]];
      sides[geometry::triangle_of(twins_[h])] = static_cast<std::int8_t>(agree ? side : -side);
      component.push_back(geometry::triangle_of(twins_[h]));
    }
}

void Repairer::orient() {
  find_twins_and_borders();
  std::vector<std::int8_t> sides(count());
  std::vector<std::int32_t> component;
  for (std::size_t start = 0; start < count(); ++start) {
    if (sides[start] != 0) continue;
    spread(static_cast<std::int32_t>(start), sides, component);
    const auto wrong = [&](std::int32_t t) { return sides[t] < 0; };
    const bool most_are = 2 * static_cast<std::size_t>(std::ranges::count_if(component, wrong)) > component.size();
    for (const std::int32_t t : component) {
      if (wrong(t) == most_are) continue;
      turn(t);
      ++report_.turned_triangles;
    }
  }
}

// Walks along the borders, over each from its end to its start. Where the walk comes back to a vertex, it has been
// around a hole. Holes may touch in a vertex, and are filled one by one.
void Repairer::fill_holes() {
  find_twins_and_borders();
  if (borders_.empty()) return;
  std::vector<std::vector<geometry::HalfEdge>> ending_at(soup_.points.size());
  for (const geometry::HalfEdge h : borders_) ending_at[geometry::end_of(soup_.triangles, h)].push_back(h);
  // the place of the border that ends at each vertex
  std::vector<std::ptrdiff_t> place_on_walk(soup_.points.size(), no_index);
  std::vector<geometry::HalfEdge> walk;
  const auto cut_off = [&](std::ptrdiff_t length) {
    for (auto h = walk.begin() + length; h != walk.end(); ++h)
      place_on_walk[geometry::end_of(soup_.triangles, *h)] = no_index;
    walk.resize(static_cast<std::size_t>(length));
  };
  // The borders of the triangles that were there before: filling holes adds no borders.
  const std::vector<geometry::HalfEdge> borders = borders_;
  for (const geometry::HalfEdge first : borders) {
    for (Vertex at = geometry::end_of(soup_.triangles, first); !ending_at[at].empty();) {
      const geometry::HalfEdge h = ending_at[at].back();
      ending_at[at].pop_back();
      place_on_walk[at] = std::ssize(walk);
      walk.push_back(h);
      at = geometry::start_of(soup_.triangles, h);
      const std::ptrdiff_t begin = place_on_walk[at];
      if (begin == no_index) continue;
      const std::vector<geometry::HalfEdge> loop(walk.begin() + begin, walk.end());
      cut_off(begin);
      if (loop.size() >= 3 && loop.size() <= options_.largest_hole) close_hole(loop);
    }
    cut_off(0);
  }
}

void Repairer::close_hole(const std::vector<geometry::HalfEdge>& border) {
  std::vector<HoleEdge> edges;
  edges.reserve(border.size());
  for (const geometry::HalfEdge h : border)
    edges.push_back({.start = geometry::end_of(soup_.triangles, h),
                     .across = geometry::start_of(soup_.triangles, geometry::previous_in_triangle(h))});
  const std::vector<Triangle> triangles = fill_hole(soup_.points, edges);
  if (triangles.empty()) return;
  const std::int32_t beside = geometry::triangle_of(border.front());
  for (const Triangle& t : triangles) {
    soup_.triangles.push_back(t);
    soup_.tags.push_back(soup_.tags[beside]);
    soup_.places.push_back(soup_.places[beside]);
  }
  ++report_.filled_holes;
  report_.hole_triangles += triangles.size();
}

void Repairer::remove_folds(const FoldRule& rule) {
  const FoldReport folds = solid::remove_folds(soup_, rule);
  report_.mended_folds = folds.places;
  report_.fold_triangles = folds.triangles;
}

// Turns only components that do not lie in another: a component inside another may be a hole on purpose.
void Repairer::turn_outward() {
  find_twins_and_borders();
  if (!borders_.empty()) return;
  std::vector<std::int8_t> sides(count());
  std::vector<std::vector<std::int32_t>> components;
  std::vector<std::int32_t> component_of(count());
  for (std::size_t start = 0; start < count(); ++start) {
    if (sides[start] != 0) continue;
    spread(static_cast<std::int32_t>(start), sides, components.emplace_back());
    for (const std::int32_t t : components.back()) component_of[t] = static_cast<std::int32_t>(components.size()) - 1;
  }
  const geometry::ColumnIndex columns(soup_.points, soup_.triangles);
  for (std::size_t p = 0; p < components.size(); ++p) {
    const Vec3& origin = soup_.points[soup_.triangles[components[p].front()][0]];
    double volume = 0;
    for (const std::int32_t t : components[p]) {
      const auto [a, b, c] = soup_.triangles[t];
      volume += det(soup_.points[a] - origin, soup_.points[b] - origin, soup_.points[c] - origin);
    }
    int crossings = 0;
    columns.for_each_crossing(origin,
                              [&](std::int32_t t) { crossings += component_of[t] != static_cast<std::int32_t>(p); });
    if (volume >= 0 || crossings % 2 == 1) continue;
    for (const std::int32_t t : components[p]) turn(t);
    report_.turned_triangles += components[p].size();
  }
}

void Repairer::drop_unused_points() {
  std::vector<Vertex> new_index(soup_.points.size(), no_index);
  std::vector<Vec3> points;
  for (Triangle& t : soup_.triangles)
    for (Vertex& v : t) {
      if (new_index[v] == no_index) {
        new_index[v] = static_cast<Vertex>(points.size());
        points.push_back(soup_.points[v]);
      }
      v = new_index[v];
    }
  soup_.points = std::move(points);
  formats::renumber_curves(soup_, new_index);
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

ModelExtent extent_of(const formats::SurfaceSoup& soup) {
  ModelExtent extent{.diagonal = geometry::Box::around(soup.points).diagonal()};
  const Vec3& origin = soup.points.front();
  for (const auto& [a, b, c] : soup.triangles) {
    const Vec3 p = soup.points[a] - origin, q = soup.points[b] - origin, r = soup.points[c] - origin;
    extent.area += norm(cross(q - p, r - p)) / 2;
    extent.volume += det(p, q, r) / 6;
  }
  extent.volume = std::abs(extent.volume);
  return extent;
}

}  // namespace

std::string RepairReport::sentence() const {
  std::vector<std::string> acts;
  if (welded_points > 0) acts.push_back(counted(welded_points, "point") + " welded");
  if (cut_borders > 0) acts.push_back(counted(cut_borders, "point") + " on an edge of another triangle joined to it");
  if (degenerate_triangles > 0) acts.push_back(counted(degenerate_triangles, "triangle") + " without area removed");
  if (duplicate_triangles > 0) acts.push_back(counted(duplicate_triangles, "repeated triangle") + " removed");
  if (stray_triangles > 0) acts.push_back(counted(stray_triangles, "stray triangle") + " removed");
  if (turned_triangles > 0) acts.push_back(counted(turned_triangles, "triangle") + " turned round");
  if (filled_holes > 0)
    acts.push_back(counted(filled_holes, "hole") + " filled by " + counted(hole_triangles, "triangle"));
  if (mended_folds > 0)
    acts.push_back(counted(mended_folds, "self-intersection") + " mended by " + counted(fold_triangles, "triangle") +
                   " made anew");
  return fmt::format("{}", fmt::join(acts, ", "));
}

nlohmann::ordered_json to_json(const RepairReport& report) {
  return {{"welded_points", report.welded_points},
          {"cut_borders", report.cut_borders},
          {"degenerate_triangles", report.degenerate_triangles},
          {"duplicate_triangles", report.duplicate_triangles},
          {"stray_triangles", report.stray_triangles},
          {"turned_triangles", report.turned_triangles},
          {"filled_holes", report.filled_holes},
          {"hole_triangles", report.hole_triangles},
          {"mended_folds", report.mended_folds},
          {"fold_triangles", report.fold_triangles}};
}

RepairReport repair(formats::SurfaceSoup& soup, const RepairOptions& options) {
  if (!soup.sides.empty())
    throw DataError::at(soup.name,
                        "expected a surface that does not say what is on its sides for --repair, found "
                        "surface/sides.npy; tessellate heals shapes");
  return Repairer(soup, options).repair();
}

void mend_folds(formats::SurfaceSoup& soup, RepairReport& report) {
  const double size = default_size(extent_of(soup), std::numeric_limits<double>::infinity());
  const RepairReport folds = Repairer(soup, {}).mend_folds(mended_share_of_size * size);
  report.mended_folds = folds.mended_folds;
  report.fold_triangles = folds.fold_triangles;
}

RepairReport mend(formats::SurfaceSoup& soup, BaffleRule baffles) {
  return Repairer(soup, {}).mend(baffles);
}

}  // namespace hexpipe::tetmesh::solid
