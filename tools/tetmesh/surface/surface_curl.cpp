#include "tools/tetmesh/surface/surface_curl.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "tools/tetmesh/fields/curl_correction.hpp"
#include "tools/tetmesh/fields/layers_across.hpp"
#include "tools/tetmesh/surface/feature_paths.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// The smaller the stiffness, the further from the place of need do rows stretch. On the fine size of
// tests/bench/points, 0.005 gives 0.1 % more of the volume in hexes on larger models and 1.6 % less on simp; 0.05 gives
// 0.4 % less than 0.02 on larger ones.
constexpr fields::CurlLimits curl_limits{.stiffness = 0.01f, .most_iterations = 300, .tolerance = 1e-3};
// Numbers of steps are better known where rows stretch further for them: at 0.01 rows end in the middle of long faces.
// 0.001 presses what is between two grids at an angle: mambo-s22 has 113 row ends then, 73 at 0.01.
constexpr fields::CurlLimits limits_of_rows{.stiffness = 0.003f, .most_iterations = 600, .tolerance = 1e-3};
// A distance may gain or lose this share of its length. Where more is wanted, rows have to end.
constexpr double most_strain = 0.3;

// Rows stretch for steps along features of these lengths, in sizes. Where the deviation asks for shorter steps, rows
// end.
constexpr double shortest_step = 0.55, longest_step = 1.8;

std::vector<float> distances_of(const SurfaceLinks& links) {
  std::vector<float> distances(2 * links.of.size());
  links.for_each_pair([&](geometry::HalfEdge h) {
    for (std::size_t k = 0; k < 2; ++k)
      distances[SurfaceLinks::number_of(h, k)] = static_cast<float>(links.of[h].distance[k]);
  });
  return distances;
}

// Adds a loop around the start of a half-edge for both directions of its triangle, unless a feature is in the way or
// the direction comes back as another one.
void add_loops_around(const SurfaceLinks& links, geometry::HalfEdge first, fields::Loops& loops) {
  for (std::size_t k = 0; k < 2; ++k) {
    FollowedAxis followed{k};
    geometry::HalfEdge h = first;
    do {
      if (links.of[h].neighbour == no_index || links.of[h].weight <= 0) return loops.drop();
      loops.add_step(followed.cross(links, h));
      h = geometry::next_in_triangle(links.surface.twins[h]);
    } while (h != first);
    if (followed.axis != k || followed.flipped) return loops.drop();
    loops.close();
  }
}

fields::Loops loops_around_vertices(const SurfaceLinks& links) {
  fields::Loops loops;
  std::vector<bool> seen(links.surface.points.size());
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(links.of.size()); ++h) {
    const Vertex v = geometry::start_of(links.surface.triangles, h);
    if (seen[v]) continue;
    seen[v] = true;
    add_loops_around(links, h, loops);
  }
  return loops;
}

template <class Body>
void for_each_fan(const SurfaceLinks& links, Body&& body) {
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(links.of.size()); ++h)
    if (links.surface.feature[h])
      if (const auto fan = feature_fan(links, h)) body(*fan);
}

template <class Body>
void for_each_corner(const SurfaceLinks& links, Body&& body) {
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(links.of.size()); ++h)
    if (links.surface.feature[h] && !feature_fan(links, h)) body(h);
}

// Rows beside a feature run along it.
void add_row_along(const FeatureFan& fan, fields::Loops& loops) {
  for (const fields::LoopStep& step : fan.across) loops.add_step(step);
  loops.close(fan.apart);
}

// For each half-edge of a feature: the length of the curve between the kept vertices before and after it. 0 where there
// are none, and for other half-edges.
std::vector<double> step_lengths(const FieldSurface& surface, std::span<const Vertex> kept) {
  std::vector<bool> is_kept(surface.points.size());
  for (const Vertex v : kept) is_kept[v] = true;
  const auto count = static_cast<geometry::HalfEdge>(surface.twins.size());
  // One of the feature's half-edges from a vertex, then both.
  std::vector<geometry::HalfEdge> onward(surface.points.size(), no_index);
  std::vector<geometry::HalfEdge> backward = onward;
  for (geometry::HalfEdge h = 0; h < count; ++h) {
    if (!surface.feature[h]) continue;
    const Vertex v = geometry::start_of(surface.triangles, h);
    (onward[v] < 0 ? onward[v] : backward[v]) = h;
  }
  std::vector<double> lengths(surface.twins.size());
  std::vector<geometry::HalfEdge> step;
  for (geometry::HalfEdge first = 0; first < count; ++first) {
    if (!surface.feature[first] || !is_kept[geometry::start_of(surface.triangles, first)]) continue;
    double length = 0;
    step.clear();
    for (geometry::HalfEdge h = first; h >= 0;) {
      step.push_back(h);
      length += norm(surface.edge_vector(h));
      const Vertex v = geometry::end_of(surface.triangles, h);
      h = is_kept[v] ? -1 : onward[v] == surface.twins[h] ? backward[v] : onward[v];
    }
    for (const geometry::HalfEdge h : step) lengths[h] = length;
  }
  return lengths;
}

bool follows_field(const SurfaceLinks& links, geometry::HalfEdge h) {
  const std::int32_t f = geometry::triangle_of(h);
  const Vec3 edge = links.surface.edge_vector(h);
  return dot(FollowedAxis::nearest(links, f, edge).in(links, f), unit(edge)) > aligned_cosine;
}

// Around a corner, from one of a face's features there to the other, rows lead to the same point.
void add_corner(const SurfaceLinks& links, geometry::HalfEdge first, fields::Loops& loops) {
  const FieldSurface& surface = links.surface;
  const Vec3& corner = surface.points[geometry::start_of(surface.triangles, first)];
  const auto ahead = [&](const FollowedAxis& axis, std::int32_t f) {
    return dot(axis.in(links, f), surface.centres[f] - corner) / surface.sizes[f];
  };
  if (!follows_field(links, first)) return;
  for (std::size_t k = 0; k < 2; ++k) {
    FollowedAxis followed{k};
    const double before = ahead(followed, geometry::triangle_of(first));
    geometry::HalfEdge h = geometry::previous_in_triangle(first);
    for (; !surface.feature[h]; h = geometry::previous_in_triangle(surface.twins[h])) {
      if (links.of[h].weight <= 0) return loops.drop();
      loops.add_step(followed.cross(links, h));
    }
    if (geometry::triangle_of(h) == geometry::triangle_of(first) || !follows_field(links, h)) return loops.drop();
    loops.close(before - ahead(followed, geometry::triangle_of(h)));
  }
}

// The distance from the middle of one edge to the middle of the other is as many steps as the edges are parts of.
void add_known_steps(const SurfaceLinks& links, const FeatureFan& fan, const std::vector<double>& step_length,
                     fields::Loops& loops) {
  const double first_length = step_length[fan.first], last_length = step_length[fan.last];
  const auto is_about_a_size = [&](double length, geometry::HalfEdge h) {
    const double sizes = length / links.surface.sizes[geometry::triangle_of(h)];
    return sizes > shortest_step && sizes < longest_step;
  };
  if (!is_about_a_size(first_length, fan.first) || !is_about_a_size(last_length, fan.last)) return;
  const FieldSurface& surface = links.surface;
  const double steps =
      0.5 * (norm(surface.edge_vector(fan.first)) / first_length + norm(surface.edge_vector(fan.last)) / last_length);
  const double first_ahead = fan.first_ahead * links.surface.sizes[geometry::triangle_of(fan.first)] / first_length;
  const double last_ahead = fan.last_ahead * links.surface.sizes[geometry::triangle_of(fan.last)] / last_length;
  for (const fields::LoopStep& step : fan.along) loops.add_step(step);
  loops.close(steps - first_ahead + last_ahead);
}

// The distance is the same on both sides of a curve.
void add_same_steps(const SurfaceLinks& links, const FeatureFan& fan, fields::Loops& loops) {
  const auto& twins = links.surface.twins;
  if (twins[fan.last] < fan.first) return;                                   // counted already, from the other side
  if (twins[fan.last] == fan.last || twins[fan.first] == fan.first) return;  // at a border
  const auto other = feature_fan(links, twins[fan.last]);
  if (!other || other->last != twins[fan.first]) return;
  for (const fields::LoopStep& step : fan.along) loops.add_step(step);
  for (const fields::LoopStep& step : other->along) loops.add_step(step.number, !step.backwards);
  loops.close(other->first_ahead - other->last_ahead - fan.first_ahead + fan.last_ahead);
}

// The distance is also the same in all sheets that meet in a curve.
void add_same_steps_at_joints(const SurfaceLinks& links, fields::Loops& loops) {
  std::map<std::pair<std::int32_t, std::int32_t>, FeatureFan> last_known;  // by the joints before and after a vertex
  const auto& joint = links.surface.joint;
  for_each_fan(links, [&](const FeatureFan& fan) {
    if (joint[fan.first] == no_index || joint[fan.last] == no_index) return;
    const auto [known, is_new] = last_known.try_emplace(std::minmax(joint[fan.first], joint[fan.last]), fan);
    if (is_new) return;
    const FeatureFan& other = known->second;
    for (const fields::LoopStep& step : fan.along) loops.add_step(step);
    for (const fields::LoopStep& step : other.along) loops.add_step(step.number, !step.backwards);
    loops.close(other.first_ahead - other.last_ahead - fan.first_ahead + fan.last_ahead);
    known->second = fan;
  });
}

// Between two features that are near each other, rows are counted in the same way everywhere.
void add_rows_between(const SurfaceLinks& links, geometry::HalfEdge feature, fields::Loops& loops) {
  const auto strip = narrow_strip(links, feature, fields::widest_to_decide);
  if (!strip || strip->width < shortest_step) return;
  for (const fields::LoopStep& step : strip->across) loops.add_step(step);
  loops.close(strip->before + strip->after - fields::layers_across(strip->width));
}

std::vector<float> find_corrections(const SurfaceLinks& links, std::span<const Vertex> kept) {
  fields::Loops loops = loops_around_vertices(links);
  const std::vector<double> step_length = step_lengths(links.surface, kept);
  for_each_fan(links, [&](const FeatureFan& fan) {
    add_row_along(fan, loops);
    add_known_steps(links, fan, step_length, loops);
  });
  for_each_corner(links, [&](geometry::HalfEdge h) { add_corner(links, h, loops); });
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(links.of.size()); ++h)
    if (links.surface.feature[h]) add_rows_between(links, h, loops);
  return fields::curl_correction<2>(distances_of(links), loops, curl_limits);
}

}  // namespace

void correct_curl(SurfaceLinks& links, std::span<const Vertex> kept) {
  const std::vector<float> corrections = find_corrections(links, kept);
  links.change_distances([&](geometry::HalfEdge h, SurfaceLink& link) {
    const std::int32_t f = geometry::triangle_of(h);
    const double longest =
        most_strain * norm(links.surface.centres[f] - links.surface.centres[link.neighbour]) / links.surface.sizes[f];
    link.correct(std::span(corrections).subspan(SurfaceLinks::number_of(h, 0), 2), longest);
  });
}

std::vector<double> steps_along_features(const SurfaceLinks& links) {
  fields::Loops loops = loops_around_vertices(links);
  for_each_fan(links, [&](const FeatureFan& fan) {
    add_row_along(fan, loops);
    add_same_steps(links, fan, loops);
  });
  add_same_steps_at_joints(links, loops);
  for_each_corner(links, [&](geometry::HalfEdge h) { add_corner(links, h, loops); });
  std::vector<float> distances = distances_of(links);
  const std::vector<float> correction = fields::curl_correction<2>(distances, loops, limits_of_rows);
  for (std::size_t i = 0; i < distances.size(); ++i) distances[i] += correction[i];
  std::vector<double> steps(links.of.size());
  for_each_fan(links, [&](const FeatureFan& fan) {
    double sum = fan.first_ahead - fan.last_ahead;
    for (const auto& [number, backwards] : fan.along) sum += backwards ? -distances[number] : distances[number];
    steps[fan.first] = sum;
  });
  return steps;
}

}  // namespace hexpipe::tetmesh::surface
