#include "tools/tetmesh/surface/links_across.hpp"

#include <algorithm>
#include <numeric>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// The weight of a square of the size on the other side of a wall of one size. Six models at two levels and three sizes
// each of tests/bench/points have 93.9 % of the volume in hexes without it, 94.5 % at 1, 94.6 % at 4, 94.5 % at 10.
constexpr double weight_across = 4;
// The bend of the surface at a triangle is measured over this many sizes either way: flat facets of a cylinder are
// narrower.
constexpr double bend_reach = 1.5, shortest_walk = 0.5;

// In radians by sizes, along the direction of the field in which the surface bends most.
double bend_of(const SurfaceLinks& links, const FieldWalker& walker, std::int32_t f) {
  const SurfacePoint centre{links.surface.centres[f], f};
  const double reach = bend_reach * links.surface.sizes[f];
  double most = 0;
  for (const Vec3& axis : links.field.axes(links.surface, f)) {
    const WalkEnd ahead = walker.walk_straight(centre, axis, reach),
                  behind = walker.walk_straight(centre, -axis, reach);
    const double length = (ahead.length + behind.length) / links.surface.sizes[f];
    if (length < shortest_walk) continue;
    const auto& normals = links.surface.normals;
    most = std::max(most, norm(normals[ahead.point.triangle] - normals[behind.point.triangle]) / length);
  }
  return most;
}

// The weight is 0 if they have too little in common.
SurfaceLink link_across(const SurfaceLinks& links, const FieldWalker& walker, const OppositeSide& opposite) {
  SurfaceLink link;
  const std::int32_t f = opposite.from, g = opposite.triangle;
  link.neighbour = g;
  const auto here = links.field.axes(links.surface, f), there = links.field.axes(links.surface, g);
  const double trust = trust_in_match(link.match(here, there));
  // By which share the numbers of rows on the two sides differ: because of the sizes asked for, and because a bend
  // makes one side longer.
  const auto [finer, coarser] = std::minmax(links.surface.sizes[f], links.surface.sizes[g]);
  double difference = coarser / finer - 1;
  if (trust > 0 && difference < 1) difference += bend_of(links, walker, f) * opposite.distance;
  link.weight =
      weight_across * trust * std::max(0.0, 1 - difference) * opposite.area / std::max(1.0, opposite.distance);
  const Vec3 back =
      (2 / (links.surface.sizes[f] + links.surface.sizes[g])) * (links.surface.centres[f] - links.surface.centres[g]);
  for (std::size_t k = 0; k < 2; ++k)
    link.way[k] = link.distance[k] = 0.5 * dot(here[k] + link.matched(k, there), back);
  return link;
}

}  // namespace

LinksAcross::LinksAcross(const SurfaceLinks& links, std::span<const OppositeSide> opposite)
    : offsets_(links.surface.sizes.size() + 1) {
  const FieldWalker walker(links.surface, links.field);
  std::vector<SurfaceLink> found(opposite.size());
  parallel_for(static_cast<std::int64_t>(found.size()), 64,
               [&](std::int64_t i) { found[i] = link_across(links, walker, opposite[i]); });
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].weight <= 0) continue;
    ++offsets_[opposite[i].from + 1];
    ++offsets_[found[i].neighbour + 1];
  }
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  links_.resize(static_cast<std::size_t>(offsets_.back()));
  std::vector<std::int64_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].weight <= 0) continue;
    links_[next[opposite[i].from]++] = found[i];
    links_[next[found[i].neighbour]++] = found[i].reversed(opposite[i].from);
  }
}

}  // namespace hexpipe::tetmesh::surface
