#include "tools/tetmesh/solid/borders.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "common/mesh/joined_sets.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

using formats::SurfaceSoup;
using geometry::HalfEdge;

std::vector<HalfEdge> borders_of(const SurfaceSoup& soup) {
  std::vector<HalfEdge> borders;
  geometry::for_each_edge(soup.points.size(), soup.triangles, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) borders.push_back(edge[0]);
  });
  return borders;
}

// In ascending order.
std::vector<Vertex> vertices_of(const SurfaceSoup& soup, std::span<const HalfEdge> edges) {
  std::vector<Vertex> vertices;
  for (const HalfEdge h : edges) {
    vertices.push_back(geometry::start_of(soup.triangles, h));
    vertices.push_back(geometry::end_of(soup.triangles, h));
  }
  std::ranges::sort(vertices);
  vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
  return vertices;
}

Vec3 normal_of(const SurfaceSoup& soup, const Triangle& t) {
  const Vec3& a = soup.points[t[0]];
  return cross(soup.points[t[1]] - a, soup.points[t[2]] - a);
}

// Places on one border, in the order from its start.
struct Cut {
  double at;  // share of the way
  Vertex point;
};

class BorderCutter {
 public:
  BorderCutter(SurfaceSoup& soup, double tolerance) : soup_(soup), tolerance_(tolerance) {}

  // Cuts each triangle along one of its borders at most; returns the number of places.
  std::size_t cut_once() {
    borders_ = borders_of(soup_);
    if (borders_.empty()) return 0;
    find_cuts();
    std::vector<bool> touched(soup_.triangles.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < borders_.size(); ++i) {
      const std::int32_t t = geometry::triangle_of(borders_[i]);
      if (cuts_[i].empty() || touched[t]) continue;
      touched[t] = true;
      count += cut(borders_[i], cuts_[i]);
    }
    return count;
  }

 private:
  void find_cuts() {
    cuts_.assign(borders_.size(), {});
    std::vector<Box> boxes;
    for (const HalfEdge h : borders_) boxes.push_back(Box::around(std::vector{start(h), end(h)}));
    const BoxTree tree(boxes, std::vector<double>(boxes.size(), 0));
    for (const Vertex v : vertices_of(soup_, borders_))
      tree.least(soup_.points[v], 1, tolerance_, [&](std::int32_t i) {
        add_if_on(static_cast<std::size_t>(i), v);
        return tolerance_;  // goes on to the others
      });
    for (auto& cuts : cuts_) std::ranges::sort(cuts, {}, &Cut::at);
  }

  void add_if_on(std::size_t i, Vertex v) {
    const HalfEdge h = borders_[i];
    if (std::ranges::find(soup_.triangles[geometry::triangle_of(h)], v) !=
        soup_.triangles[geometry::triangle_of(h)].end())
      return;
    const Vec3 &from = start(h), along = end(h) - from, to_point = soup_.points[v] - from;
    const double length = norm(along), at = dot(to_point, along) / (length * length);
    constexpr double shortest = 50;  // tolerances: nearer to an end, the point is meant to be the end
    if (!(std::min(at, 1 - at) * length > shortest * tolerance_)) return;
    if (norm(to_point - at * along) <= tolerance_) cuts_[i].push_back({at, v});
  }

  // Replaces the triangle by a fan from the corner across. Each new triangle must lie as the old one does.
  std::size_t cut(HalfEdge h, const std::vector<Cut>& cuts) {
    const std::int32_t t = geometry::triangle_of(h);
    const Vertex from = geometry::start_of(soup_.triangles, h), to = geometry::end_of(soup_.triangles, h);
    const Vertex across = geometry::end_of(soup_.triangles, geometry::next_in_triangle(h));
    const Vec3 normal = normal_of(soup_, soup_.triangles[t]);
    std::vector<Triangle> fan;
    Vertex last = from;
    for (const Cut& cut : cuts) fan.push_back({std::exchange(last, cut.point), cut.point, across});
    fan.push_back({last, to, across});
    for (const Triangle& cut : fan)
      if (!(dot(normal_of(soup_, cut), normal) > 0)) return 0;
    soup_.triangles[t] = fan.front();
    for (std::size_t i = 1; i < fan.size(); ++i) {
      soup_.triangles.push_back(fan[i]);
      soup_.tags.push_back(soup_.tags[t]);
      soup_.places.push_back(soup_.places[t]);
      if (!soup_.sides.empty()) soup_.sides.push_back(soup_.sides[t]);
    }
    return cuts.size();
  }

  const Vec3& start(HalfEdge h) const { return soup_.points[geometry::start_of(soup_.triangles, h)]; }
  const Vec3& end(HalfEdge h) const { return soup_.points[geometry::end_of(soup_.triangles, h)]; }

  SurfaceSoup& soup_;
  double tolerance_;
  std::vector<HalfEdge> borders_;
  std::vector<std::vector<Cut>> cuts_;  // by border
};

// A component of a soup: triangles that hang together by edges.
struct Component {
  std::size_t triangles = 0;
  double area = 0, border = 0;
  bool is_open = false;
};

}  // namespace

bool is_sheet(double area, double border) {
  return border * border >= 4 * std::numbers::pi * area;
}

void keep_only(SurfaceSoup& soup, const std::vector<bool>& kept) {
  const auto filter = [&](auto& array) {
    if (array.empty()) return;
    std::size_t next = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i]) array[next++] = array[i];
    array.resize(next);
  };
  filter(soup.triangles), filter(soup.tags), filter(soup.places), filter(soup.sides);
}

double rounding_of(const SurfaceSoup& soup) {
  double greatest = 0;
  for (const Vec3& p : soup.points) greatest = std::max({greatest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  constexpr double share_of_coordinate = 1e-6, most_of_diagonal = 1e-4;
  return std::min(share_of_coordinate * greatest, most_of_diagonal * Box::around(soup.points).diagonal());
}

std::size_t weld_borders(SurfaceSoup& soup, double tolerance) {
  const std::vector<HalfEdge> borders = borders_of(soup);
  if (borders.empty()) return 0;
  std::map<Vertex, std::vector<Vertex>> neighbours;
  const std::vector<Vertex> loose = vertices_of(soup, borders);
  for (const Triangle& t : soup.triangles)
    for (const Vertex v : t)
      if (std::ranges::binary_search(loose, v)) neighbours[v].insert(neighbours[v].end(), t.begin(), t.end());
  geometry::SizedPointGrid grid(geometry::Box::around(soup.points));
  std::vector<Vertex> added, becomes(soup.points.size(), no_index);
  std::size_t count = 0;
  for (const Vertex v : loose) {
    double least = tolerance;
    grid.for_each_near(soup.points[v], tolerance, 0, [&](std::int32_t i) {
      const double distance = norm(grid.points()[i] - soup.points[v]);
      const bool is_beside = std::ranges::find(neighbours[v], added[i]) != neighbours[v].end();
      if (distance <= least && !is_beside) least = distance, becomes[v] = added[i];
      return true;
    });
    if (becomes[v] == no_index) {
      grid.add(soup.points[v], tolerance);
      added.push_back(v);
    } else {
      auto& beside = neighbours[becomes[v]];
      beside.insert(beside.end(), neighbours[v].begin(), neighbours[v].end());
      ++count;
    }
  }
  const auto rename = [&](Vertex& v) {
    if (becomes[v] != no_index) v = becomes[v];
  };
  for (Triangle& t : soup.triangles) std::ranges::for_each(t, rename);
  for (formats::CurveEdge& edge : soup.curves) std::ranges::for_each(edge, rename);
  return count;
}

std::size_t cut_at_border_points(SurfaceSoup& soup, double tolerance) {
  constexpr int most_rounds = 20;  // a triangle has three borders, and what it is cut into may have others
  std::size_t count = 0;
  BorderCutter cutter(soup, tolerance);
  for (int round = 0; round < most_rounds; ++round) {
    const std::size_t more = cutter.cut_once();
    count += more;
    if (more == 0) break;
  }
  return count;
}

bool has_borders(const SurfaceSoup& soup) {
  return !borders_of(soup).empty();
}

std::size_t remove_stray_sheets(SurfaceSoup& soup) {
  constexpr std::size_t few = 4;
  constexpr double small_share = 0.01;
  const std::size_t triangles = soup.triangles.size();
  JoinedSets sets(triangles);
  std::vector<double> border(triangles);
  geometry::for_each_edge(soup.points.size(), soup.triangles, [&](std::span<const HalfEdge> edge) {
    for (const HalfEdge h : edge) sets.join(geometry::triangle_of(edge[0]), geometry::triangle_of(h));
    if (edge.size() == 1)
      border[geometry::triangle_of(edge[0])] += norm(soup.points[geometry::end_of(soup.triangles, edge[0])] -
                                                     soup.points[geometry::start_of(soup.triangles, edge[0])]);
  });
  std::map<std::int32_t, Component> components;
  for (std::size_t t = 0; t < triangles; ++t) {
    Component& component = components[sets.of(static_cast<std::int32_t>(t))];
    ++component.triangles;
    component.area += norm(normal_of(soup, soup.triangles[t])) / 2;
    component.border += border[t];
    component.is_open = component.is_open || border[t] > 0;
  }
  constexpr std::size_t fewest_of_body = 4;
  const auto bounds = [](const Component& component) {
    return !component.is_open && component.triangles >= fewest_of_body;
  };
  double closed_area = 0;
  for (const auto& [first, component] : components) closed_area += bounds(component) ? component.area : 0;
  const auto is_stray = [&](const Component& component) {
    if (closed_area == 0 || bounds(component)) return false;
    if (!component.is_open) return true;
    return is_sheet(component.area, component.border) &&
           (component.triangles <= few || component.area <= small_share * closed_area);
  };
  std::vector<bool> kept(triangles);
  for (std::size_t t = 0; t < triangles; ++t) kept[t] = !is_stray(components[sets.of(static_cast<std::int32_t>(t))]);
  keep_only(soup, kept);
  return static_cast<std::size_t>(std::ranges::count(kept, false));
}

}  // namespace hexpipe::tetmesh::solid
