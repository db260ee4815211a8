#include "tools/tetmesh/solid/shells.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "common/run/error.hpp"
#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

// The facts about a shell that its result leaves out.
struct Draft {
  double signed_volume = 0;            // positive: normals point outward
  std::optional<std::int32_t> parent;  // the innermost shell around it
  int depth = 0;                       // the number of shells around it
};

// The number of each triangle's connected component. Components are ordered by their first triangles.
std::vector<std::int32_t> number_components(std::size_t point_count, std::span<const Triangle> triangles) {
  const std::vector<geometry::HalfEdge> twins = geometry::find_twins(point_count, triangles);
  std::vector<std::int32_t> component(triangles.size(), no_index), stack;
  std::int32_t count = 0;
  for (std::size_t start = 0; start < triangles.size(); ++start) {
    if (component[start] != no_index) continue;
    component[start] = count;
    stack.assign(1, static_cast<std::int32_t>(start));
    while (!stack.empty()) {
      const std::int32_t t = stack.back();
      stack.pop_back();
      for (geometry::HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const std::int32_t neighbour = geometry::triangle_of(twins[h]);
        if (component[neighbour] != no_index) continue;
        component[neighbour] = count;
        stack.push_back(neighbour);
      }
    }
    ++count;
  }
  return component;
}

// Counts the triangles of the shells and measures their volumes. Returns the volumes with their signs.
std::vector<double> measure_shells(Surface& surface) {
  for (Shell& shell : surface.shells) shell.triangle_count = 0;
  for (std::size_t i = surface.triangles.size(); i-- > 0;) {
    Shell& shell = surface.shells[surface.shell_of[i]];
    shell.first_triangle = static_cast<std::int32_t>(i);
    ++shell.triangle_count;
  }
  std::vector<double> volumes(surface.shells.size());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    // Measured from a corner of the shell, so that volumes far from the origin keep their digits.
    const std::int32_t s = surface.shell_of[i];
    const Vec3& origin = surface.points[surface.triangles[surface.shells[s].first_triangle][0]];
    const auto [a, b, c] = surface.triangles[i];
    volumes[s] += det(surface.points[a] - origin, surface.points[b] - origin, surface.points[c] - origin) / 6;
  }
  for (std::size_t s = 0; s < volumes.size(); ++s) surface.shells[s].volume = std::abs(volumes[s]);
  return volumes;
}

class ShellFinder {
 public:
  ShellFinder(formats::SurfaceSoup soup, ShellRule rule) : surface_{std::move(soup), {}, {}, 0, false}, rule_(rule) {}

  Surface find() {
    collect_shells();
    find_parents();
    if (surface_.sides.empty()) {
      number_regions();
      assign_sides();
    } else {
      take_given_sides();
    }
    orient_triangles();
    choose_tags(surface_);
    return std::move(surface_);
  }

 private:
  void collect_shells();
  void find_parents();
  void number_regions();
  void take_given_sides();
  bool encloses_material(const Draft& shell) const;
  void assign_sides();
  void assign_sides(std::int32_t shell);
  void orient_triangles();

  Surface surface_;
  ShellRule rule_;
  std::vector<Draft> drafts_;
};

void ShellFinder::collect_shells() {
  surface_.shell_of = number_components(surface_.points.size(), surface_.triangles);
  surface_.shells.resize(std::ranges::max(surface_.shell_of) + 1);
  for (const double volume : measure_shells(surface_)) drafts_.push_back({volume, std::nullopt, 0});
}

// Shells do not meet, so one vertex of a shell tells which shells are around all of it.
void ShellFinder::find_parents() {
  if (drafts_.size() == 1) return;
  const geometry::ColumnIndex index(surface_.points, surface_.triangles);
  std::vector<std::int32_t> crossed;
  for (std::size_t s = 0; s < drafts_.size(); ++s) {
    crossed.clear();
    const Vec3& p = surface_.points[surface_.triangles[surface_.shells[s].first_triangle][0]];
    index.for_each_crossing(p, [&](std::int32_t t) {
      if (surface_.shell_of[t] != static_cast<std::int32_t>(s)) crossed.push_back(surface_.shell_of[t]);
    });
    std::ranges::sort(crossed);
    for (auto run = crossed.begin(); run != crossed.end();) {
      const auto end = std::upper_bound(run, crossed.end(), *run);
      if ((end - run) % 2 == 1) {
        ++drafts_[s].depth;
        auto& parent = drafts_[s].parent;
        if (!parent || surface_.shells[*run].volume < surface_.shells[*parent].volume) parent = *run;
      }
      run = end;
    }
  }
}

void ShellFinder::number_regions() {
  for (std::size_t s = 0; s < drafts_.size(); ++s) {
    Shell& shell = surface_.shells[s];
    shell.has_material = encloses_material(drafts_[s]);
    if (shell.has_material) shell.behind = ++surface_.region_count;
  }
}

// The surface tells for each of its triangles what is on the sides; the shells take that over.
void ShellFinder::take_given_sides() {
  for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
    const std::int32_t s = surface_.shell_of[i];
    const std::int32_t first = surface_.shells[s].first_triangle;
    if (surface_.sides[i] != surface_.sides[first])
      throw DataError::at(
          surface_.place_of(i),
          "expected regions {} and {} on its sides, as of other triangles of its shell, found {} and {}",
          surface_.sides[first][0], surface_.sides[first][1], surface_.sides[i][0], surface_.sides[i][1]);
  }
  for (std::size_t s = 0; s < drafts_.size(); ++s) {
    Shell& shell = surface_.shells[s];
    const auto [behind, before] = surface_.sides[shell.first_triangle];
    const bool points_outward = drafts_[s].signed_volume > 0;
    const std::int32_t inside = points_outward ? behind : before, around = points_outward ? before : behind;
    shell.has_material = inside != outside_region;
    shell.behind = shell.has_material ? inside : around;
    shell.in_front = shell.has_material ? around : inside;
    surface_.region_count = std::max({surface_.region_count, behind, before});
  }
}

bool ShellFinder::encloses_material(const Draft& shell) const {
  switch (rule_) {
    case ShellRule::oriented:
      return shell.signed_volume > 0;
    case ShellRule::holes:
      return shell.depth % 2 == 0;
    case ShellRule::regions:
      break;
  }
  return true;
}

// Works from the outside inwards: a shell's outer side is its parent's inner side.
void ShellFinder::assign_sides() {
  std::vector<std::int32_t> order(drafts_.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::int32_t s) { return drafts_[s].depth; });
  for (const std::int32_t s : order) assign_sides(s);
}

void ShellFinder::assign_sides(std::int32_t s) {
  std::int32_t surrounding = outside_region;
  if (const auto parent = drafts_[s].parent; parent && surface_.shells[*parent].has_material)
    surrounding = surface_.shells[*parent].behind;
  Shell& shell = surface_.shells[s];
  (shell.has_material ? shell.in_front : shell.behind) = surrounding;
  if (shell.behind == outside_region)
    throw DataError::at(surface_.place_of(shell.first_triangle),
                        "expected a shell that points outward, found {} triangles that point inward with no material "
                        "around them (see --shells)",
                        shell.triangle_count);
}

void ShellFinder::orient_triangles() {
  for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
    const std::int32_t s = surface_.shell_of[i];
    const bool points_outward = drafts_[s].signed_volume > 0;
    if (points_outward != surface_.shells[s].has_material)
      std::swap(surface_.triangles[i][1], surface_.triangles[i][2]);
  }
}

// A name of the whole surface stays if the whole gets a single tag again.
void rename_only_tag(Surface& surface) {
  const auto found = surface.names.surfaces.find(surface.tags.front());
  std::map<std::int32_t, std::string> names;
  if (found != surface.names.surfaces.end() && surface.shells.size() == 1) names[1] = found->second;
  surface.names.surfaces = std::move(names);
}

}  // namespace

void choose_tags(Surface& surface) {
  const bool file_tells =
      surface.has_own_tags || std::ranges::adjacent_find(surface.tags, std::not_equal_to()) != surface.tags.end();
  if (file_tells) return;
  rename_only_tag(surface);
  for (std::size_t i = 0; i < surface.tags.size(); ++i) surface.tags[i] = surface.shell_of[i] + 1;
}

std::vector<double> Surface::region_volumes() const {
  std::vector<double> volumes(region_count + 1);
  if (has_sheets) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto [a, b, c] = triangles[i];
      const Shell& sheet = shells[shell_of[i]];
      const double volume = det(points[a] - points[0], points[b] - points[0], points[c] - points[0]) / 6;
      volumes[sheet.behind] += volume;
      volumes[sheet.in_front] -= volume;
    }
    volumes[outside_region] = 0;
    return volumes;
  }
  for (const Shell& shell : shells) {
    volumes[shell.behind] += shell.has_material ? shell.volume : -shell.volume;
    if (shell.has_material) volumes[shell.in_front] -= shell.volume;
  }
  volumes[outside_region] = 0;
  return volumes;
}

double Surface::volume() const {
  double volume = 0;
  for (const double region : region_volumes()) volume += region;
  return volume;
}

bool is_in_material(const Surface& surface, const geometry::ColumnIndex& columns, const Vec3& p) {
  bool inside = false;
  columns.for_each_crossing(p, [&](std::int32_t t) {
    if (surface.shells[surface.shell_of[t]].in_front == outside_region) inside = !inside;
  });
  return inside;
}

Surface find_shells(formats::SurfaceSoup soup, ShellRule rule) {
  return ShellFinder(std::move(soup), rule).find();
}

Surface with_shells_of(const Surface& surface, formats::SurfaceSoup soup, std::vector<std::int32_t> shell_of) {
  Surface other{std::move(soup), std::move(shell_of), surface.shells, surface.region_count, surface.has_sheets};
  measure_shells(other);
  return other;
}

}  // namespace hexpipe::tetmesh::solid
