#include "tools/tetmesh/solid/surface_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "common/mesh/joined_sets.hpp"
#include "common/mesh/vertex_items.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

// Intersections are counted up to this number: n copies of a triangle have n²/2 of them.
constexpr std::size_t most_told_intersections = 10'000;
// At most this many triangles of an edge are listed.
constexpr std::size_t most_triangles_listed = 8;

std::string count_of(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string text_of(const Vec3& p) {
  return fmt::format("({:g}, {:g}, {:g})", p.x, p.y, p.z);
}

// For example "triangles 3, 7 and 12"; lines for a text file.
template <class Triangles>
std::string list_of(const formats::SurfaceSoup& soup, const Triangles& triangles) {
  std::vector<std::int64_t> places;
  places.reserve(std::size(triangles));
  for (const auto t : triangles) places.push_back(soup.places[t]);
  std::ranges::sort(places);
  const std::size_t listed = std::min(places.size(), most_triangles_listed);
  std::string text =
      fmt::format("{}s {}", soup.place_unit(), fmt::join(places.begin(), places.begin() + listed - 1, ", "));
  return text + (listed < places.size() ? fmt::format(", {}, ...", places[listed - 1])
                                        : fmt::format(" and {}", places[listed - 1]));
}

void check_no_degenerate_triangles(const formats::SurfaceSoup& soup, std::string_view remedy) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = soup.triangles.size(); i-- > 0;) {
    const auto [a, b, c] = soup.triangles[i];
    if (!geometry::are_collinear(soup.points[a], soup.points[b], soup.points[c])) continue;
    ++count;
    first = i;
  }
  if (count == 0) return;
  const auto [a, b, c] = soup.triangles[first];
  throw DataError::at(soup.place_of(first),
                      "expected triangles with an area, found {} without; the first has corners {}, {}, {}{}", count,
                      text_of(soup.points[a]), text_of(soup.points[b]), text_of(soup.points[c]), remedy);
}

void check_no_repeated_triangles(const formats::SurfaceSoup& soup, std::string_view remedy) {
  // Triangles that are the same have the same lowest vertex, which leaves a handful at a time to sort.
  const VertexItems at_lowest(soup.points.size(), [&](auto&& visit) {
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      visit(std::ranges::min(soup.triangles[t]), static_cast<std::int32_t>(t));
  });
  std::vector<std::pair<Triangle, std::int32_t>> sorted;  // corners, ascending, and number
  std::size_t count = 0;
  std::array<std::int32_t, 2> first{};  // the repetition that comes first in the file, and what it repeats
  for (Vertex v = 0; v < static_cast<Vertex>(soup.points.size()); ++v) {
    sorted.clear();
    for (const std::int32_t t : at_lowest.at(v)) {
      sorted.emplace_back(soup.triangles[t], t);
      std::ranges::sort(sorted.back().first);
    }
    std::ranges::sort(sorted);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i].first != sorted[i - 1].first) continue;
      if (count++ == 0 || sorted[i].second < first[0]) first = {sorted[i].second, sorted[i - 1].second};
    }
  }
  if (count == 0) return;
  throw DataError::at(soup.place_of(first[0]),
                      "expected distinct triangles, found {} with the corners of another; the first repeats {} {}{}",
                      count, soup.place_unit(), soup.places[first[1]], remedy);
}

// Edges with one kind of fault: their number, and the edge whose triangle comes first in the file.
struct FaultyEdges {
  std::size_t count = 0;
  std::vector<geometry::HalfEdge> first;

  void add(std::span<const geometry::HalfEdge> edge) {
    if (count++ == 0 || edge[0] < first[0]) first.assign(edge.begin(), edge.end());
  }
};

void check_edges(const formats::SurfaceSoup& soup, std::string_view remedy) {
  FaultyEdges open, crowded;
  geometry::for_each_edge(soup.points.size(), soup.triangles, [&](std::span<const geometry::HalfEdge> edge) {
    if (edge.size() == 1) open.add(edge);
    if (edge.size() > 2) crowded.add(edge);
  });
  auto edge_text = [&](geometry::HalfEdge h) {
    return fmt::format("from {} to {}", text_of(soup.points[geometry::start_of(soup.triangles, h)]),
                       text_of(soup.points[geometry::end_of(soup.triangles, h)]));
  };
  if (crowded.count > 0) {
    std::vector<std::int32_t> triangles;
    for (const geometry::HalfEdge h : crowded.first) triangles.push_back(geometry::triangle_of(h));
    throw DataError::at(soup.place_of(triangles[0]),
                        "expected two triangles at every edge, found {} with more; the first, {}, belongs to {}",
                        count_of(crowded.count, "edge"), edge_text(crowded.first[0]), list_of(soup, triangles));
  }
  if (open.count > 0)
    throw DataError::at(soup.place_of(geometry::triangle_of(open.first[0])),
                        "expected a closed surface, found {} of a single triangle; the first is {}{}",
                        count_of(open.count, "edge"), edge_text(open.first[0]), remedy);
}

bool agree(std::span<const Triangle> triangles, geometry::HalfEdge h, geometry::HalfEdge twin) {
  return geometry::start_of(triangles, h) == geometry::end_of(triangles, twin);
}

// Walks over one connected component and gives each triangle the side that it shows: 1 like the first one, -1 turned
// over. Returns a half-edge where two ways round disagree, if there is one.
std::optional<geometry::HalfEdge> spread_sides(std::span<const Triangle> triangles,
                                               std::span<const geometry::HalfEdge> twins, std::int32_t start,
                                               std::vector<std::int8_t>& sides, std::vector<std::int32_t>& component) {
  std::optional<geometry::HalfEdge> conflict;
  component.assign(1, start);
  sides[start] = 1;
  for (std::size_t i = 0; i < component.size(); ++i) {
    const std::int32_t t = component[i];
    for (geometry::HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      const std::int32_t neighbour = geometry::triangle_of(twins[h]);
      const auto side = static_cast<std::int8_t>(agree(triangles, h, twins[h]) ? sides[t] : -sides[t]);
      if (sides[neighbour] == 0) {
        sides[neighbour] = side;
        component.push_back(neighbour);
      } else if (sides[neighbour] != side && !conflict) {
        conflict = h;
      }
    }
  }
  return conflict;
}

void check_orientation(const formats::SurfaceSoup& soup, std::span<const geometry::HalfEdge> twins,
                       std::string_view remedy) {
  std::vector<std::int8_t> sides(soup.triangles.size());
  std::vector<std::int32_t> component, flipped;
  for (std::size_t start = 0; start < sides.size(); ++start) {
    if (sides[start] != 0) continue;
    const auto conflict = spread_sides(soup.triangles, twins, static_cast<std::int32_t>(start), sides, component);
    if (conflict)
      throw DataError::at(soup.place_of(geometry::triangle_of(*conflict)),
                          "expected a surface with two sides, found one that has a single side, like Möbius' strip");
    const auto turned =
        static_cast<std::size_t>(std::ranges::count(component, -1, [&](std::int32_t t) { return sides[t]; }));
    // The minority is at fault.
    const int wrong_side = 2 * turned <= component.size() ? -1 : 1;
    std::ranges::copy_if(component, std::back_inserter(flipped),
                         [&](std::int32_t t) { return sides[t] == wrong_side; });
  }
  if (flipped.empty()) return;
  throw DataError::at(soup.place_of(std::ranges::min(flipped)),
                      "expected neighbours with one orientation, found {} flipped against the others{}{}",
                      count_of(flipped.size(), "triangle"), flipped.size() == 1 ? "" : "; the first is here", remedy);
}

// Every edge has two triangles by now, so the triangles at a vertex form cycles. A manifold vertex has one cycle.
void check_vertices(const formats::SurfaceSoup& soup, std::span<const geometry::HalfEdge> twins) {
  std::vector<std::int32_t> unseen(soup.points.size());
  for (const Triangle& t : soup.triangles)
    for (const Vertex v : t) ++unseen[v];
  std::vector<bool> walked(soup.points.size());
  std::size_t count = 0;
  geometry::HalfEdge first = no_index;
  const auto half_edge_count = static_cast<geometry::HalfEdge>(twins.size());
  for (geometry::HalfEdge h = 0; h < half_edge_count; ++h) {
    const Vertex v = geometry::start_of(soup.triangles, h);
    if (walked[v]) continue;
    walked[v] = true;
    geometry::HalfEdge around = h;
    do {
      --unseen[v];
      around = twins[geometry::previous_in_triangle(around)];
    } while (around != h);
    if (unseen[v] > 0 && count++ == 0) first = h;
  }
  if (count == 0) return;
  const Vertex v = geometry::start_of(soup.triangles, first);
  throw DataError::at(soup.place_of(geometry::triangle_of(first)),
                      "expected one fan of triangles at every vertex, found {} where several touch; the first is {}",
                      count == 1 ? "1 vertex" : fmt::format("{} vertices", count), text_of(soup.points[v]));
}

// The options of tessellate that may help with intersections. Only its bundles say what is on the sides.
const char* hint_for_cad(const formats::SurfaceSoup& soup, std::span<const std::array<std::int32_t, 2>> pairs) {
  if (soup.sides.empty()) return "";
  const auto are_of_two_bodies = [&](const std::array<std::int32_t, 2>& pair) {
    const auto &one = soup.sides[pair[0]], &other = soup.sides[pair[1]];
    return std::ranges::none_of(
        one, [&](std::int32_t region) { return region > 0 && std::ranges::find(other, region) != other.end(); });
  };
  return std::ranges::all_of(pairs, are_of_two_bodies)
             ? "; where bodies touch, tessellate --join makes one face of two; where they are joined, try another "
               "--deviation"
             : "; from CAD, try another --deviation, larger or smaller, or --angle of tessellate, or tessellate --open "
               "| wrap";
}

// How many of the pairs are of two bodies that --unite takes: they are closed, as far as the edges go that they have
// with others, and point outward.
std::size_t count_of_two_bodies(const formats::SurfaceSoup& soup, std::span<const std::array<std::int32_t, 2>> pairs) {
  if (!soup.sides.empty()) return 0;
  JoinedSets bodies(soup.triangles.size());
  bool is_closed = true;
  geometry::for_each_edge(soup.points.size(), soup.triangles, [&](std::span<const geometry::HalfEdge> edge) {
    is_closed = is_closed && edge.size() % 2 == 0;
    for (const geometry::HalfEdge h : edge) bodies.join(geometry::triangle_of(edge[0]), geometry::triangle_of(h));
  });
  if (!is_closed) return 0;
  std::vector<double> volume(soup.triangles.size());  // six times that, by the number of a body
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const std::int32_t body = bodies.of(static_cast<std::int32_t>(t));
    const Vec3& origin = soup.points[soup.triangles[body][0]];
    const auto [a, b, c] = soup.triangles[t];
    volume[body] += det(soup.points[a] - origin, soup.points[b] - origin, soup.points[c] - origin);
  }
  return static_cast<std::size_t>(std::ranges::count_if(pairs, [&](const std::array<std::int32_t, 2>& pair) {
    const std::int32_t one = bodies.of(pair[0]), other = bodies.of(pair[1]);
    return one != other && volume[one] > 0 && volume[other] > 0;
  }));
}

// --unite does not mend bodies that intersect themselves.
std::string remedy_for(const formats::SurfaceSoup& soup, std::span<const std::array<std::int32_t, 2>> pairs,
                       std::string_view remedy) {
  const std::size_t of_two_bodies = count_of_two_bodies(soup, pairs);
  if (of_two_bodies == pairs.size()) return " (see --unite)";
  if (of_two_bodies == 0 || !remedy.ends_with(')')) return std::string(remedy);
  return fmt::format("{}, then --unite)", remedy.substr(0, remedy.size() - 1));
}

void check_no_intersections(const formats::SurfaceSoup& soup, const geometry::IntersectionReport& report,
                            std::string_view remedy) {
  if (report.pairs.empty()) return;
  throw SelfIntersection(DataError::at(
      soup.place_of(report.pairs.front()[0]),
      "expected a surface that does not intersect itself, found {}{} of triangles that do; the first: {}{}{}",
      report.complete ? "" : "more than ", count_of(report.pairs.size(), "pair"), list_of(soup, report.pairs.front()),
      hint_for_cad(soup, report.pairs), remedy_for(soup, report.pairs, remedy)));
}

}  // namespace

void check_surface(const formats::SurfaceSoup& soup, std::string_view remedy) {
  check_no_degenerate_triangles(soup, remedy);
  check_no_repeated_triangles(soup, remedy);
  geometry::IntersectionReport report;
  check_edges(soup, remedy);
  both_at_once(
      [&] {
        const std::vector<geometry::HalfEdge> twins = geometry::find_twins(soup.points.size(), soup.triangles);
        check_orientation(soup, twins, remedy);
        check_vertices(soup, twins);
      },
      [&] { report = geometry::find_intersections(soup.points, soup.triangles, most_told_intersections); });
  check_no_intersections(soup, report, remedy);
}

void check_areas(const formats::SurfaceSoup& soup, std::string_view remedy) {
  check_no_degenerate_triangles(soup, remedy);
}

void check_intersections(const formats::SurfaceSoup& soup, std::string_view remedy) {
  check_no_intersections(soup, geometry::find_intersections(soup.points, soup.triangles, most_told_intersections),
                         remedy);
}

}  // namespace hexpipe::tetmesh::solid
